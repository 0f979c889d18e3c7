#include "core/joint/section/section_place.hpp"

#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

PreparedTube moved(PreparedTube tube, const Vector2d& axis) {
  const double along = axis.x() * tube.cos_clocking + axis.y() * tube.sin_clocking;
  const double beside = axis.y() * tube.cos_clocking - axis.x() * tube.sin_clocking;
  tube.offset += along;
  tube.height -= beside * tube.cos_inclination / tube.sin_inclination;
  return tube;
}

PreparedPlane moved(PreparedPlane plane, const Vector2d& axis) {
  plane.height += plane.slope_x * axis.x() + plane.slope_y * axis.y();
  return plane;
}

template <class OnAxis>
requires requires(OnAxis kind) { kind.frame.point; }
OnAxis moved(OnAxis kind, const Vector2d& axis) {
  kind.frame.point -= Vector3d(axis.x(), axis.y(), 0.0);
  return kind;
}

PreparedElbow moved(PreparedElbow elbow, const Vector2d& axis) {
  elbow.center -= Vector3d(axis.x(), axis.y(), 0.0);
  return elbow;
}

}  // namespace

Generator generator_through(const Vector2d& point) {
  const double radius = std::sqrt(point.squaredNorm());
  return {radius, point.x() / radius, point.y() / radius};
}

Hit section_hit(const PreparedCutter& cutter, const section::Station& at) {
  const auto line = generator_through(at.point);
  Hit out = continued_hit(cutter, line);
  const double cos = line.cos_phi * at.normal.x() + line.sin_phi * at.normal.y();
  const double sin = line.cos_phi * at.normal.y() - line.sin_phi * at.normal.x();
  const Vector3d n = out.normal;
  out.normal = {n.x() * cos + n.y() * sin, n.y() * cos - n.x() * sin, n.z()};
  out.z_dphi = -out.normal.y() / out.normal.z();
  return out;
}

PreparedCutter seen_from(const PreparedCutter& cutter, const Vector2d& axis) {
  return by_kind(cutter, [&](const auto& kind) -> PreparedCutter { return moved(kind, axis); });
}

std::vector<PreparedCutter> seen_from(const std::vector<PreparedCutter>& cutters,
                                      const Vector2d& axis) {
  std::vector<PreparedCutter> out;
  out.reserve(cutters.size());
  for (const auto& cutter : cutters) out.push_back(seen_from(cutter, axis));
  return out;
}

}  // namespace tubecut::joint
