#pragma once

#include <cstdint>

// clang-format off: one row a code
/// Every warning code of the service, in one place: `GET /v1/errors` and the OpenAPI enum derive
/// from these rows. A code's meaning never changes within v1.
///
/// X(code, severity, meaning, action): severity `cut` makes the verdict `review`, `note` does not.
#define TUBECUT_WARNINGS(X)                                                                       \
  X(cutter_missed, note, "This partner does not touch the target.",                               \
    "Check its position, or omit it.")                                                            \
  X(near_parallel, note,                                                                          \
    "The axes are within 5 degrees of parallel; the cut is long and sensitive.",                  \
    "Check the inclination; measure the tube's straightness before cutting.")                     \
  X(events_between_nodes, note,                                                                   \
    "Events lie between the uniform points; the largest shortfall is given.",                     \
    "Add a tolerance to the sampling, so that events become nodes.")                              \
  X(torch_range_binds, cut, "The torch range limits the groove angle here.",                      \
    "Widen the torch range if the machine allows it, or accept the opened groove.")               \
  X(smoothed_below_raw, cut, "The published smoothing falls below its input here.",               \
    "Use smoothing envelope.")                                                                    \
  X(ghost_contact, cut, "The cut follows a partner beyond that member's end.",                    \
    "Check the partner's length, or omit it.")                                                    \
  X(corner_shared, note, "Two ends meet at a corner of the member that they stand on.",           \
    "Both end flat on its faces, or at the plane between them; state a joint for another cut.")   \
  X(comparison_only, cut,                                                                         \
    "Comparison only, do not cut: B and the root reproduce a published figure.",                  \
    "To cut, request dihedral weld_side.")                                                        \
  X(free_end, cut, "This end meets no member, though one is near.",                               \
    "Move the end to its member, raise within_mm, or cut it square.")                             \
  X(end_open, cut, "No partner covers some angles of this end, so the cut is not closed.",        \
    "Add an end plane, or check diameters and offsets.")                                          \
  X(end_consumed, cut, "The cut at this end reaches beyond the member's other end.",              \
    "Check the member's length and the positions of its partners.")                               \
  X(no_table, cut, "This end has no bevel table, because it cannot be cut as requested.",         \
    "Fix the reported cause, or cut this end another way.")                                       \
  X(no_part, cut, "This member has no part, because it cannot be cut as requested.",              \
    "Fix the reported cause. The other parts of the frame are valid.")                            \
  X(joint_not_stated, cut, "A hole is requested for a joint that the members do not define.",     \
    "State the joint of the two members.")                                                        \
  X(hole_missing, cut, "A member enters this part, but no hole is requested for it.",             \
    "Request the hole, or state another joint.")                                                  \
  X(members_overlap, cut, "Two finished members overlap; neither is cut to clear the other.",     \
    "State which of the two is cut, or move one.")                                                \
  X(wall_overhangs, cut, "Part of the wall extends past its partners and is unsupported.",        \
    "Check offset and diameters; trim or cap the overhang.")                                      \
  X(mitre_steps, cut, "Two mitred members differ in diameter or miss each other: edges step.",    \
    "Use equal tubes whose axes meet, or another joint.")                                         \
  X(parallel_members, cut, "Two members that join are parallel; neither cuts the other.",         \
    "Join them by a plane or a sleeve.")                                                          \
  X(root_opens, cut, "The root gap is widened so that the cut can be made.",                      \
    "Check that the weld procedure allows this root gap.")                                        \
  X(holes_meet, cut, "Two holes of the part overlap.",                                            \
    "Move a hole or the tubes, or cut one opening for both.")                                     \
  X(hole_meets_end, cut, "A hole of the part reaches into the cut at one of its ends.",           \
    "Move the hole or the end, or check that the welds may meet.")                                \
  X(unit_suspicion, cut, "The value seems to be given in another unit.",                          \
    "Check the unit; correct the value, or acknowledge it.")                                      \
  X(tube_outside_range, note, "The tube is outside the range the machine was built for.",         \
    "Check that the machine holds this tube.")                                                    \
  X(target_missed, cut, "The cycle makes fewer pieces an hour than requested.",                   \
    "Use a faster feed or a shorter stroke, or lower the target.")                                \
  X(not_cut_through, cut, "The work feed is shorter than the tube's wall.",                       \
    "Lengthen the work feed to more than the wall.")                                              \
  X(polynomial_window, note, "The polynomial is valid only within its time window.",              \
    "Use the polynomial only within its window.")                                                 \
  X(monotone_work_range, note,                                                                    \
    "The speed has no maximum within the work feed; T/2 is the middle node.",                     \
    "Check that the nodes suit the run, or give nodes_s.")                                        \
  X(root_in_bore, cut, "The root face lies below the chord's bore.",                              \
    "Choose a root nearer to the chord's outside, or use backing.")                               \
  X(p2_inside_branch, note, "The weld's toe on the chord lies inside the branch's outer radius.", \
    "Check the weld's width and the position of the toe.")                                        \
  X(branch_wider, note, "The branch is wider than the chord.", "Check the diameters.")            \
  X(groove_angle, note, "The groove line is outside 10..80 degrees to the branch axis.",          \
    "Check that torch and welder reach into the groove.")                                         \
  X(root_face_cut, cut, "The mill cuts into the root face.",                                      \
    "Use another mill or groove, or accept the depth given.")                                     \
  X(window_not_reached, cut, "A position stays outside the qualification window.",                \
    "Widen the window, or mill this segment by hand.")                                            \
  X(contour_too_coarse, cut, "The contour's points are too far apart for the tolerance.",         \
    "Sample the contour more finely.")                                                            \
  X(slow_zone, cut, "The tip falls below half of the requested speed here.",                      \
    "Check heat and dross there, or raise the axis limits.")                                      \
  X(invariant_broken, cut, "The schedule breaks an invariant; do not run it.",                    \
    "Do not run it; report the request id.")                                                      \
  X(standoff, cut, "The stand-off changes and this machine cannot compensate it.",                \
    "Use a machine with a height axis, or accept the stand-off given.")                           \
  X(land_left, cut, "The schedule cuts only the bevel; the root face below is left uncut.",       \
    "Cut the root face before: passes=both of G-code, or another way.")                           \
  X(enters_partner, cut, "Between two rows, the finished cut enters a partner.",                  \
    "Use a finer sampling, or grind to fit here.")                                                \
  X(grazes, cut, "A straight wall of the cut-out grazes the tube: the metal along it is thick.",  \
    "Make the cut-out narrower, or lay it on the outside: wall developed.")                       \
  X(spent_beam, cut, "The spent beam of a countersink meets the far side of its hole.",           \
    "Use a narrower angle, or drill the countersink.")                                            \
  X(countersink_open, note, "At the tube's sides the countersink stays within its hole.",         \
    "Use a greater diameter if the head must bear all round.")                                    \
  X(shoulder_off, cut, "The beam's fillets next to the tabs hold the shoulder off the wall.",     \
    "Widen the clearance to half the kerf, notch the corners, or accept the gap.")
// clang-format on

namespace tubecut {

enum class Severity : std::uint8_t { note, cut };

enum class WarningCode : std::uint8_t {
#define X(code, severity, meaning, action) code,
  TUBECUT_WARNINGS(X)
#undef X
};

}  // namespace tubecut
