#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::math {

/// Return right-handed rotations by an angle in rad. They use the reproducible sine and cosine,
/// because Eigen's own would call the C library's.
[[nodiscard]] inline Eigen::Matrix3d turn_about_y(double angle) {
  const auto t = elementary::sincos(angle);
  Eigen::Matrix3d out;
  out << t.cos, 0.0, t.sin, 0.0, 1.0, 0.0, -t.sin, 0.0, t.cos;
  return out;
}

[[nodiscard]] inline Eigen::Matrix3d turn_about_z(double angle) {
  const auto t = elementary::sincos(angle);
  Eigen::Matrix3d out;
  out << t.cos, -t.sin, 0.0, t.sin, t.cos, 0.0, 0.0, 0.0, 1.0;
  return out;
}

/// Returns phi reduced to [0, 2 pi).
[[nodiscard]] inline double whole_turn(double phi) {
  const double turned = phi - kTwoPi * std::floor(phi / kTwoPi);
  return turned < kTwoPi ? turned : 0.0;
}

}  // namespace tubecut::math
