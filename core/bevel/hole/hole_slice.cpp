#include "core/bevel/hole/hole_slice.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"

namespace tubecut::bevel {

math::Polygon slice(const joint::Target& target, const Hole& hole, double u, double turn) {
  const double inner = target.inner_radius(), outer = target.outer_radius;
  const double rho = inner + u * (outer - inner);
  math::Polygon out;
  for (auto* column : {&out.x, &out.y}) column->reserve(hole.phi.size());
  for (std::size_t i = 0; i < hole.phi.size() && !stops(i); ++i) {
    // In the plane across the tube: from (inner, 0) by d, until rho from the axis.
    const auto swing = elementary::sincos(hole.phi[i] - hole.phi_inner[i]);
    const Eigen::Vector2d d{outer * swing.cos - inner, outer * swing.sin};
    const double half = inner * d.x(), square = d.squaredNorm();
    const double root = half * half + square * (rho * rho - inner * inner);
    const double s = (std::sqrt(std::max(0.0, root)) - half) / square;
    out.x.push_back(turn + hole.phi_inner[i] + elementary::atan2(s * d.y(), inner + s * d.x()));
    out.y.push_back(hole.z_inner[i] + s * (hole.z[i] - hole.z_inner[i]));
  }
  return out;
}

}  // namespace tubecut::bevel
