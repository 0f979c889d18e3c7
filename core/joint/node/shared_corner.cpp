#include "core/joint/node/shared_corner.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/joint/node/shape.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr double kAlongFace = 1e-3;  // cosine to a face's normal below which a member runs along it
constexpr double kPastEdge = 0.1;    // mm: coordinates are rounded
constexpr double kOntoFace = 0.1;    // cosine from which a member stands on a face

Vector3d into(const EndOf& one) { return one.member.into(one.end).normalized(); }

/// The face that a member leaves the chord by: its normal, and its distance from the chord's axis.
struct ChordFace {
  Vector3d normal;
  double half;
};
std::optional<ChordFace> face_of(const Member& chord, const Vector3d& along) {
  const Vector3d height = height_of(chord);
  const Vector3d width = (chord.finish - chord.start).normalized().cross(height);
  std::optional<ChordFace> out;
  double most = kOntoFace;
  for (const Vector3d& normal : std::array<Vector3d, 4>{height, -height, width, -width})
    if (const double cosine = normal.dot(along); cosine > most) {
      most = cosine;
      out = ChordFace{normal, support(chord, normal)};
    }
  return out;
}

/// Returns true if a member that runs along a face reaches into the rounding at its edge.
bool reaches_rounding(const EndOf& one, const ChordFace& face, const Member& chord) {
  if (std::abs(into(one).dot(face.normal)) > kAlongFace) return false;
  const double reach =
      (one.member.at(one.end) - chord.start).dot(face.normal) + support(one.member, face.normal);
  return reach > face.half - chord.section->corner && reach <= face.half + kPastEdge;
}

/// Returns true if an end of another member, at the same chord, shares its corner with this end.
bool shares(const Joints& joints, std::size_t index, std::size_t end, std::size_t chord) {
  const auto& [spec, applied, lines, joined] = joints;
  const auto member = index / 2, other = end / 2;
  const EndOf a{spec.members[member], end_of(index)}, b{spec.members[other], end_of(end)};
  const double most =
      far_end(a.member, b.member) + 2.0 * spec.members[chord].reach();  // others face elsewhere
  if (member == other || (a.member.at(a.end) - b.member.at(b.end)).norm() > most) return false;
  const auto pair = std::minmax(member, other);
  if (applied.joints.contains(pair) && !applied.found.contains(pair)) return false;
  return is_set_on(applied, member, chord) && is_set_on(applied, other, chord) &&
         !applied.mitres.contains({index, other}) && lines.goes_before(spec, chord, other) &&
         share_corner(a, b, spec.members[chord]);
}

}  // namespace

bool share_corner(const EndOf& a, const EndOf& b, const Member& chord) {
  if (!chord.section || !a.member.section || !b.member.section) return false;
  const auto first = face_of(chord, into(a)), second = face_of(chord, into(b));
  if (!first || !second || std::abs(first->normal.dot(second->normal)) > 0.5) return false;
  return reaches_rounding(a, *second, chord) && reaches_rounding(b, *first, chord);
}

SharedCorners shared_corners(const Joints& joints) {
  std::vector<std::vector<std::size_t>> at(joints.spec.members.size());  // the ends that join each
  for (std::size_t end = 0; end < joints.joined.size(); ++end)
    for (const auto& touch : joints.joined[end])
      if (joints.spec.members[touch.other].section) at[touch.other].push_back(end);
  SharedCorners out(joints.joined.size());
  for (std::size_t chord = 0; chord < at.size(); ++chord)
    for (const auto p : at[chord])
      for (const auto q : at[chord])
        if (shares(joints, p, q, chord)) out[p].push_back({chord, q / 2});
  return out;
}

bool flush_at_mitre(const Joints& joints, std::size_t end,
                    const std::pair<std::size_t, std::size_t>& chords) {
  constexpr double kFlushFaces = 0.05;  // mm
  const auto& [spec, applied, lines, joined] = joints;
  const auto& [a, b] = chords;
  const auto& m = spec.members[end / 2];
  const auto& p = spec.members[a];
  const auto& q = spec.members[b];
  if (a == b || !p.section || !q.section || !m.section) return false;
  const bool mitred =
      applied.mitres.contains({2 * a, b}) || applied.mitres.contains({2 * a + 1, b});
  const Vector3d along = m.into(end_of(end)).normalized();
  const auto stands_on = [&](const Member& chord) {
    const Vector3d axis = (chord.finish - chord.start).normalized();
    return std::abs(axis.dot(along)) <= kAlongFace && is_square_to(chord, along);
  };
  if (!mitred || !stands_on(p) || !stands_on(q)) return false;
  const Vector3d& from = m.at(end_of(end));
  const auto top = [&](const Member& chord) {
    return (chord.start - from).dot(along) + support(chord, along);
  };
  return std::abs(top(p) - top(q)) <= kFlushFaces;
}

}  // namespace tubecut::joint::detail
