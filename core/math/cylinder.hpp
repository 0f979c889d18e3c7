#pragma once

#include <Eigen/Core>

#include "core/base/elementary.hpp"

namespace tubecut::math {

/// Returns the point with these cylinder coordinates about z.
[[nodiscard]] inline Eigen::Vector3d cylinder_point(double radius, double phi, double z) {
  const auto at = elementary::sincos(phi);
  return {radius * at.cos, radius * at.sin, z};
}

}  // namespace tubecut::math
