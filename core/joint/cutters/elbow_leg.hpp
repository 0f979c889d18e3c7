#pragma once

#include <optional>

#include "core/joint/cutters/elbow.hpp"

/// Straight legs of an elbow that run along the target, as on a pipe support on a bend.
namespace tubecut::joint {

/// If the sine is below it, a leg runs along the target. The side of such a leg is no place for a
/// cut: it is checked as far as `leg_reach`, and a leg that cuts the kept tube further away is
/// rejected.
inline constexpr double kAlongTarget = 0.01;
[[nodiscard]] inline double leg_reach(double radius, double bend_radius) {
  return 100.0 * (radius + bend_radius);
}

/// If a leg goes up along the surface of radius rho and cuts it beyond that reach, returns the sine
/// of the angle between the two.
[[nodiscard]] std::optional<double> endless_leg(const PreparedElbow& elbow, double rho);

}  // namespace tubecut::joint
