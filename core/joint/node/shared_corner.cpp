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

}  // namespace

bool share_corner(const EndOf& a, const EndOf& b, const Member& chord) {
  if (!chord.section || !a.member.section || !b.member.section) return false;
  const auto first = face_of(chord, into(a)), second = face_of(chord, into(b));
  if (!first || !second || std::abs(first->normal.dot(second->normal)) > 0.5) return false;
  return reaches_rounding(a, *second, chord) && reaches_rounding(b, *first, chord);
}

bool shares_corner(const Joints& joints, std::size_t index, std::size_t other, std::size_t chord) {
  const auto& [spec, applied, lines, joined] = joints;
  const auto member = index / 2;
  const auto pair = std::minmax(member, other);
  if (applied.joints.contains(pair) && !applied.found.contains(pair)) return false;
  if (!is_set_on(applied, member, chord) || !is_set_on(applied, other, chord) ||
      applied.mitres.contains({index, other}) || !lines.goes_before(spec, chord, other))
    return false;
  return std::ranges::any_of(std::array{2 * other, 2 * other + 1}, [&](std::size_t end) {
    return std::ranges::count(joined[end], chord, &Touch::other) > 0 &&
           share_corner({spec.members[member], end_of(index)}, {spec.members[other], end_of(end)},
                        spec.members[chord]);
  });
}

}  // namespace tubecut::joint::detail
