#pragma once

#include <Eigen/Core>

#include "core/base/elementary.hpp"

namespace tubecut::math {

/// The point of these cylinder coordinates about z.
[[nodiscard]] inline Eigen::Vector3d cylinder_point(double radius, double phi, double z) {
  const auto at = elementary::sincos(phi);
  return {radius * at.cos, radius * at.sin, z};
}

}  // namespace tubecut::math
