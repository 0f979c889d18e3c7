#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/shape.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.01;      // mm between two mitred edges: negligible
constexpr double kFoundStep = 0.5;  // for found members in line, because coordinates are rounded

/// Returns the largest distance between the outer edges of two mitred ends. Both are ellipses in
/// one plane, their centres the axes' distance from each other, half as wide as their tubes and
/// longer as these lean.
double mitre_step(const NodeSpec& spec, const MemberEnd& end, const CutBy& cut) {
  if (!cut.plane) return 0.0;
  const auto& own = spec.members[end.member];
  const auto& other = spec.members[cut.member];
  if (own.section || other.section) {
    const Eigen::Matrix3d out = end.frame.rows.transpose();
    return edge_step(own, other, end.frame.origin + out * cut.plane->point,
                     out * cut.plane->normal.normalized());
  }
  const double r = spec.members[end.member].outer_radius, s = other.outer_radius;
  const Vector3d normal = cut.plane->normal.normalized();
  const Vector3d along = end.frame.rows * (other.finish - other.start).normalized();
  return std::max(std::abs(r / normal.z() - s / std::abs(normal.dot(along))), std::abs(r - s)) +
         cut.eccentricity;
}

/// Returns how much of an end lies past the face that it is flat on, because it is wider; mm.
double flat_overhang(const NodeSpec& spec, const MemberEnd& end, const CutBy& cut) {
  const auto& chord = spec.members[cut.member];
  const auto& own = spec.members[end.member];
  const bool wide =
      cut.box && (cut.box->height > chord.section->height || cut.box->width > chord.section->width);
  return wide ? overhang(chord, own) : 0.0;
}

std::string ghost(const NodeSpec& spec, const MemberEnd& end, const CutBy& cut,
                  const Joined& joined) {
  const auto other = called(spec, cut.member);
  const auto far = brief(cut.missing) + " mm";
  if (cut.plane)
    return "ends at the plane between it and " + other + ", which another member cuts away up to " +
           far + " behind that plane; state how that member meets the two";
  if (cut.instead)
    return "cut by " + other + " beyond that member's end, where " + called(spec, *cut.instead) +
           ", which continues it, lies up to " + far + " lower";
  if (cut.past_mitre)
    return "cut by " + other + " beyond the plane at which that member is mitred, up to " + far +
           " off the metal of both";
  const auto beyond = "cut by " + other + " up to " + far + " beyond that member's end";
  const auto ends_here = [&](std::size_t at) {
    return std::ranges::count(joined[at], end.member, &Touch::other) > 0;
  };
  if (!ends_here(2 * cut.member) && !ends_here(2 * cut.member + 1)) return beyond;
  return beyond + "; both end here, so state a mitre of the two, or lengthen " + other + " by " +
         far;
}

}  // namespace

void warn(const Joints& joints, const MemberEnd& end, const std::optional<Touch>& missed,
          std::vector<Warning>& out) {
  const auto& [spec, applied, lines, joined] = joints;
  const auto at = place_of(end.member, end.end);
  const auto least = [&](const CutBy& cut) {
    return applied.found.contains(std::minmax(end.member, cut.member)) ? kFoundStep : kStep;
  };
  if (missed) {
    const auto& other = spec.members[missed->other];
    const double off = missed->near.inside > 0.0
                           ? distance_from(other, spec.members[end.member].at(end.end))
                           : missed->near.distance - other.reach();
    out.push_back({.code = WarningCode::free_end,
                   .member = at,
                   .detail = called(spec, end.member) + " meets no member here, and misses " +
                             called(spec, missed->other) + " by " + brief(off) + " mm"});
  }
  for (const auto& cut : end.cut_by)
    if (cut.ghost)
      out.push_back({.code = WarningCode::ghost_contact,
                     .member = at,
                     .detail = ghost(spec, end, cut, joined)});
  for (const auto& cut : end.cut_by)
    if (cut.plane && applied.found.contains(std::minmax(end.member, cut.member)) &&
        lines.line[end.member] != lines.line[cut.member])
      out.push_back({.code = WarningCode::corner_shared,
                     .member = at,
                     .detail = "mitred with " + called(spec, cut.member) +
                               ", because neither end can cut the other at this corner"});
  for (const auto& cut : end.cut_by)
    if (const double over = flat_overhang(spec, end, cut); over > 0.0)
      out.push_back({.code = WarningCode::wall_overhangs,
                     .member = at,
                     .detail = "flat on the face of " + called(spec, cut.member) + ", and up to " +
                               brief(over) + " mm of it lie past that face"});
  for (const auto& cut : end.cut_by)
    if (const auto& chord = spec.members[cut.member]; cut.box &&
                                                      cut.box->corner != chord.section->corner &&
                                                      !(flat_overhang(spec, end, cut) > 0.0))
      out.push_back({.code = WarningCode::corner_shared,
                     .member = at,
                     .detail = "flat on the face of " + called(spec, cut.member) +
                               ", whose corner of radius " + brief(chord.section->corner) +
                               " mm it shares with another end"});
  for (const auto& cut : end.cut_by)
    if (const double step = mitre_step(spec, end, cut); step > least(cut))
      out.push_back({.code = WarningCode::mitre_steps,
                     .member = at,
                     .detail = "its edge and that of " + called(spec, cut.member) + " are up to " +
                               brief(step) + " mm apart"});
  if (end.open) out.push_back({.code = WarningCode::end_open, .member = at});
  if (end.consumed) out.push_back({.code = WarningCode::end_consumed, .member = at});
}

}  // namespace tubecut::joint::detail
