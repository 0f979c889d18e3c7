#include "core/groove/machine_space.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::groove {

using Eigen::Vector3d;

double flank_distance(const Mill& mill, const Tool& tool, const Vector3d& p) {
  const double kappa = mill.half_angle.rad();
  if (mill.half_angle.deg() < 0.5) {
    const Vector3d to = p - tool.tip;
    return (to.cross(tool.axis).norm() - mill.tip_radius) * elementary::cos(kappa) -
           to.dot(tool.axis) * elementary::sin(kappa);
  }
  const Vector3d to = p - (tool.tip - mill.tip_radius / elementary::tan(kappa) * tool.axis);
  return to.norm() *
         elementary::sin(elementary::atan2(to.cross(tool.axis).norm(), to.dot(tool.axis)) - kappa);
}

double solid_distance(const Mill& mill, const Tool& tool, const Vector3d& p) {
  using Eigen::Vector2d;
  const Vector3d to = p - tool.tip;
  const Vector2d at(to.cross(tool.axis).norm(), to.dot(tool.axis));
  const double back = mill.tip_radius + mill.length * elementary::tan(mill.half_angle.rad());
  const std::array<Vector2d, 4> corner = {Vector2d(-mill.tip_radius, 0),
                                          Vector2d(mill.tip_radius, 0), Vector2d(back, mill.length),
                                          Vector2d(-back, mill.length)};
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector2d side = corner[(k + 1) % 4] - corner[k], from = at - corner[k];
    if (side.squaredNorm() == 0.0) continue;
    const double share = std::clamp(from.dot(side) / side.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (from - share * side).norm());
    inside = inside && side.x() * from.y() - side.y() * from.x() >= 0.0;
  }
  return inside ? -nearest : nearest;
}

}  // namespace tubecut::groove
