#pragma once

#include <cstdint>

// clang-format off: one row a code
/// Every error code of the service, in one place: `GET /v1/errors`, the OpenAPI enum and the HTTP
/// status all derive from these rows. A code's meaning never changes within v1.
///
/// X(code, kind, meaning, action): `action` is one sentence for the operator.
#define TUBECUT_ERRORS(X)                                                                          \
  /* request as bytes */                                                                           \
  X(unreadable_json, unreadable, "The body is not one strict JSON document.",                      \
    "Correct the JSON at the byte offset given.")                                                  \
  X(bad_request, unreadable, "The request line, a header or a query parameter is not valid.",      \
    "Correct the part that detail and errors name.")                                               \
  X(unauthorized, unauthorized, "No valid API key was sent.",                                      \
    "Send a key this service knows in the Authorization header.")                                  \
  X(forbidden, forbidden, "The key may not use this endpoint.",                                    \
    "Use a key with that right, or ask the operator of the service.")                              \
  X(not_found, not_found, "There is no such path.", "Check the path against /openapi.yaml.")       \
  X(method_not_allowed, method_not_allowed, "The path exists, but not with this method.",          \
    "Use a method named in the Allow header.")                                                     \
  X(not_acceptable, not_acceptable, "The answer is not available in the requested format.",        \
    "Request one of the formats listed.")                                                          \
  X(numerics_mismatch, conflict,                                                                   \
    "The request pins another numerics version than this engine has.",                             \
    "Send the job to an engine of that numerics version, or remove the pin.")                      \
  X(machine_mismatch, conflict,                                                                    \
    "This replica's machine of that name differs from the pinned one.",                            \
    "Send the job to a replica that has that machine, or remove the pin.")                         \
  X(body_too_large, too_large, "The body exceeds the limit of this endpoint.",                     \
    "Send a smaller request, or split it.")                                                        \
  X(unsupported_media_type, unsupported_media, "The body's media type is not accepted.",           \
    "Send one of the accepted types, as Content-Type.")                                            \
  X(unsupported_encoding, unsupported_media, "Content-Encoding on requests is not accepted.",      \
    "Send the body uncompressed.")                                                                 \
  /* fields */                                                                                     \
  X(invalid_request, invalid, "One or more fields are not valid; see errors[].",                   \
    "Correct every field listed in errors.")                                                       \
  X(missing_field, invalid, "A required field is missing.", "Add the field.")                      \
  X(unknown_field, invalid, "The field is not part of this request.",                              \
    "Remove or rename the field.")                                                                 \
  X(wrong_type, invalid, "The value has the wrong JSON type.",                                     \
    "Send the type that the schema requires.")                                                     \
  X(not_a_number, invalid, "A number is required.", "Send a JSON number.")                         \
  X(not_an_integer, invalid, "A whole number is required.", "Send a whole number.")                \
  X(not_finite, invalid, "The number is not finite.", "Send a finite number.")                     \
  X(out_of_range, invalid, "The value is outside its limits.", "Send a value within the limit.")   \
  X(bad_choice, invalid, "The value is not one of those offered.",                                 \
    "Send one of the values listed.")                                                              \
  X(bad_text, invalid, "The text has characters or a length that are not allowed.",                \
    "Send printable text within the length given.")                                                \
  X(wrong_count, invalid, "The array has the wrong number of elements.",                           \
    "Send the required number of elements.")                                                       \
  X(exclusive_fields, invalid, "Exactly one of these fields must be given.",                       \
    "Give exactly one of them.")                                                                   \
  X(repeated_parameter, invalid, "The query parameter is given more than once.", "Give it once.")  \
  X(unsupported_combination, invalid, "These choices cannot be combined.",                         \
    "Choose one of the combinations documented for the endpoint.")                                 \
  X(unsupported_target, invalid, "This endpoint cannot cut a target of this kind.",                \
    "Send a round target, or use an endpoint that the hint names.")                                \
  X(unknown_size, invalid, "No tube of this name is in the catalogue.",                            \
    "Use a size listed by GET /v1/tubes, or give the dimensions.")                                 \
  X(duplicate_id, invalid, "Another one has this id.", "Give each its own id.")                    \
  X(unknown_machine, invalid, "No machine of this name is in the catalogue.",                      \
    "Use a machine listed by GET /v1/machines, or describe it.")                                   \
  /* joints and bevels */                                                                          \
  X(open_profile, no_solution, "No partner covers some angles, so the cut is not closed.",         \
    "Add an end plane or check diameters and offsets.")                                            \
  X(no_contact, no_solution, "No partner meets the target.",                                       \
    "Check the offsets, heights and diameters of the partners.")                                   \
  X(parallel_axes, no_solution, "A partner's axis is parallel to the target's axis.",              \
    "Check the inclination, or use a plane.")                                                      \
  X(member_consumed, no_solution, "The cut lies beyond the far end of the member.",                \
    "Check the member's length and the positions of its partners.")                                \
  X(torch_range, no_solution,                                                                      \
    "The bevel that keeps partners out of the wall is beyond the torch's range.",                  \
    "Use contact auto, a wider torch range, or another root surface.")                             \
  X(edge_crosses, no_solution, "The edge of the hole would run through itself.",                   \
    "Use tilt axial or none, another groove, or a smaller branch.")                                \
  X(cut_enters, no_solution, "With this bevel the cut enters a partner.",                          \
    "Use contact auto, another bevel, or root and contact inner.")                                 \
  X(sampling_not_uniform, no_solution, "The chosen smoothing needs uniform points.",               \
    "Use only uniform_points, or smoothing envelope.")                                             \
  X(smoothing_not_converged, no_solution, "The published smoothing left steps above its limit.",   \
    "Raise transition_points or the limit, or use smoothing envelope.")                            \
  X(smoothing_enters, no_solution,                                                                 \
    "The published smoothing falls below the bevel that keeps partners out.",                      \
    "Use smoothing envelope.")                                                                     \
  X(transition_too_long, no_solution, "The transition would reach the next junction.",             \
    "Use smoothing envelope, or a larger mutation limit.")                                         \
  X(too_many_nodes, no_solution, "The sampling needs more nodes than allowed.",                    \
    "Use a larger tolerance.")                                                                     \
  X(ambiguous_connection, no_solution, "Two members are equally near to this end.",                \
    "Name the connection explicitly.")                                                             \
  X(joint_contradicts, no_solution, "A joint is stated in two ways that cannot both be right.",    \
    "State it once, or the same on both sides.")                                                   \
  X(zero_length, no_solution, "A direction or member has no length.",                              \
    "Check the two points or the vector.")                                                         \
  X(bad_reference_direction, no_solution, "The reference direction is parallel to the axis.",      \
    "Choose another reference direction.")                                                         \
  /* what may be cut */                                                                            \
  X(rejected, no_solution,                                                                         \
    "The verdict is reject, so a program that lights the torch is refused.",                       \
    "Change the cut until it is accepted, or request it without torch=on.")                        \
  X(not_acknowledged, no_solution,                                                                 \
    "The verdict is review, and its warnings are not all acknowledged.",                           \
    "Review each warning, then list exactly their codes in acknowledge.")                          \
  X(comparison_only, no_solution, "This answer only reproduces published figures; do not cut it.", \
    "To cut, use dihedral weld_side.")                                                             \
  X(hole_off_part, no_solution, "The hole lies wholly outside the finished part.",                 \
    "Check the position of the branch, or omit the hole.")                                         \
  /* feed curves */                                                                                \
  X(r2_lt_a, no_solution, "The pivot distance is smaller than its horizontal part.",               \
    "Check pivot_distance_mm and pivot_offset_mm.")                                                \
  X(slot_off_rod, no_solution, "The tool slot does not cross the rod's line at rest.",             \
    "Check the slot and rest angles.")                                                             \
  X(reversed, no_solution, "Extending the cylinder retracts the tool.", "Check the rest angle.")   \
  X(dead_point, no_solution, "The linkage starts on, or passes, a tangent position.",              \
    "Check the arm, the pivot distance and the rest angle.")                                       \
  X(tan_pole, no_solution, "The stroke is outside the linkage's range.",                           \
    "Use a stroke within the range given.")                                                        \
  X(unreachable_x, no_solution, "The linkage cannot reach this tool feed.",                        \
    "Use a feed within the range given.")                                                          \
  X(bad_nodes, no_solution,                                                                        \
    "The three nodes are not distinct times within the work feed, ascending.", "Correct nodes_s.") \
  X(tolerance_not_met, no_solution, "No polynomial up to degree 8 meets the tolerance.",           \
    "Raise the tolerance or shorten the range.")                                                   \
  X(s2_gt_s1, no_solution, "The slow-down distance exceeds the clearance.",                        \
    "Make slowdown_mm at most clearance_mm.")                                                      \
  X(approach_too_short, no_solution, "The approach is too short for the limits given.",            \
    "Raise the clearance or the limits.")                                                          \
  X(work_speed_above_limit, no_solution,                                                           \
    "The work feed requires more cylinder speed than allowed.", "Lower feed_mm_s.")                \
  X(work_accel_above_limit, no_solution,                                                           \
    "The work feed requires more cylinder acceleration than allowed.", "Lower feed_mm_s.")         \
  X(max_feed_exceeded, no_solution, "The tool travels beyond its largest feed.",                   \
    "Shorten the cut or raise max_feed_mm.")                                                       \
  X(too_many_samples, no_solution, "The cycle has more servo samples than allowed.",               \
    "Use a longer period or a faster feed.")                                                       \
  X(wall_too_thick, no_solution, "The wall is not smaller than the tube's radius.",                \
    "Check wall_mm.")                                                                              \
  /* grooves and mill paths */                                                                     \
  X(wall, no_solution, "A wall is not smaller than its tube's radius.", "Check the walls.")        \
  X(root_width, no_solution, "The root face leaves no groove in the wall.",                        \
    "Make the root face narrower than the branch wall.")                                           \
  X(area, no_solution, "The filler area is not positive.", "Give a positive filler area.")         \
  X(normal_area, no_solution, "Some normal sections cannot have the requested area.",              \
    "Request equal areas in axial sections: area_in axial.")                                       \
  X(angle, no_solution, "The intersecting angle is outside (0, 90] degrees.",                      \
    "Give an angle within (0, 90].")                                                               \
  X(no_pierce, no_solution, "The root cylinder does not pass wholly into the chord.",              \
    "Check diameters and eccentricity.")                                                           \
  X(no_p2, no_solution, "The chord offers no point at the weld's width.",                          \
    "Check the branch wall, the root width and the chord diameter.")                               \
  X(p2_ambiguous, no_solution, "The chord offers more than one point at the weld's width.",        \
    "Check the geometry of the joint.")                                                            \
  X(p3_below_p1, no_solution, "The filler area is too small for a groove.",                        \
    "Raise the filler area above the least one given.")                                            \
  X(groove_in_chord, no_solution, "The groove line enters the chord.", "Raise the filler area.")   \
  X(face_in_chord, no_solution, "The weld face enters the chord.", "Raise the filler area.")       \
  X(tool, no_solution, "The mill's dimensions are not possible.",                                  \
    "Check half angle, tip radius and length.")                                                    \
  X(tool_short, no_solution, "The mill is shorter than the groove.", "Use a longer mill.")         \
  X(root_collision, no_solution, "The mill's tip face would enter the root face.",                 \
    "Use a smaller half angle or another groove.")                                                 \
  X(sampling, no_solution, "The check's points, pitch and window do not fit together.",            \
    "Use at least 3 points and pitch <= window <= 90 degrees.")                                    \
  X(setup, no_solution, "The machine setup is not possible.",                                      \
    "Check mount, hold and pivot length.")                                                         \
  X(window, no_solution, "The deepest point lies on the border of the check window.",              \
    "Use a wider window.")                                                                         \
  X(contact, no_solution, "The contact line was not found.", "Use a finer pitch.")                 \
  X(z_ineffective, no_solution, "Moving Z does not change the depth of cut here.",                 \
    "Use another mount.")                                                                          \
  X(travel, no_solution, "An axis would leave its travel.", "Use another setup.")                  \
  /* pulse schedules */                                                                            \
  X(soft_limit, no_solution, "An axis would leave its soft limits.",                               \
    "Change the machine's limits, the pivot length or the cut.")                                   \
  X(not_closed, no_solution, "The contour's two ends differ.",                                     \
    "Close the contour, or send closed false.")                                                    \
  X(duplicate_point, no_solution, "Two neighbouring points are equal.", "Remove one of them.")     \
  X(turns_back, no_solution, "The contour runs back over itself.",                                 \
    "Remove the points that it passes twice.")                                                     \
  X(angle_out_of_range, no_solution, "The bevel angle is beyond 85 degrees.",                      \
    "Check the bevel angles.")                                                                     \
  X(zero_limit, no_solution, "An axis limit is zero.", "Give limits above zero.")                  \
  X(too_many_periods, no_solution, "The schedule would have more periods than allowed.",           \
    "Use a longer period, a faster cut, or CBOR.")                                                 \
  X(bad_number, no_solution, "A number of the contour or machine is not usable.",                  \
    "Check the numbers.")                                                                          \
  X(speed_table_range, no_solution, "The speed table does not cover the metal the beam must cut.", \
    "Extend the speed table.")                                                                     \
  X(standoff_too_large, no_solution, "The stand-off grows beyond what the machine allows.",        \
    "Use a machine with a height axis, or a smaller bevel.")                                       \
  X(lead_blocked, no_solution, "The lead or pierce point would lie in the finished part.",         \
    "Use a smaller lead or another start.")                                                        \
  X(schedule_invalid, no_solution, "The schedule breaks an invariant.",                            \
    "Do not run this schedule; request a new one.")                                                \
  /* service */                                                                                    \
  X(verification_failed, internal, "The answer failed its own verification and was withheld.",     \
    "Report the request id; do not cut.")                                                          \
  X(not_converged, internal, "A solver did not converge within its documented domain.",            \
    "Report the request id; do not cut.")                                                          \
  X(internal_error, internal, "The service failed.", "Report the request id.")                     \
  X(overloaded, overloaded, "All slots and the queue are full.",                                   \
    "Send the same request again after Retry-After.")                                              \
  X(rate_limited, overloaded, "This key has used its rate.",                                       \
    "Send the same request again after Retry-After.")                                              \
  X(unavailable, unavailable, "The service is starting or stopping.",                              \
    "Send the same request again after Retry-After.")                                              \
  X(cancelled, unavailable, "The job was cancelled before it was done.",                           \
    "Send the same request again.")                                                                \
  X(over_budget, timeout, "The job took longer than its budget.",                                  \
    "Use a coarser sampling or a smaller request.")                                                \
  /* cut-outs */                                                                                   \
  X(cutout_off_part, no_solution, "A cut-out does not lie wholly within the finished part.",       \
    "Move the cut-out, change its pattern, or lengthen the part.")                                 \
  X(cutouts_cross, no_solution, "A cut-out touches, crosses or encloses another opening.",         \
    "Move one of them, or cut one contour for both.")                                              \
  X(contour_open, no_solution, "The contour does not end where it begins.", "Close the contour.")  \
  X(contour_crosses, no_solution, "The contour crosses itself or encloses nothing.",               \
    "Correct the contour.")                                                                        \
  X(pattern_wraps, no_solution, "The pattern reaches round the tube onto itself.",                 \
    "Use fewer, or a smaller pitch.")                                                              \
  X(slot_too_narrow, no_solution, "A tab lacks its clearances in its slot.",                       \
    "Widen the clearances, or cut the slot with a narrower kerf.")

// clang-format on
namespace tubecut {

/// The kind of an error for the caller; the server maps each kind to one HTTP status.
enum class ErrorKind : std::uint8_t {
  unreadable,
  unauthorized,
  forbidden,
  not_found,
  method_not_allowed,
  not_acceptable,
  conflict,
  too_large,
  unsupported_media,
  invalid,
  no_solution,
  overloaded,
  internal,
  unavailable,
  timeout,
};

enum class ErrorCode : std::uint8_t {
#define X(code, kind, meaning, action) code,
  TUBECUT_ERRORS(X)
#undef X
};

}  // namespace tubecut
