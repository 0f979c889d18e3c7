#pragma once

#include <optional>

#include "core/joint/cutters/elbow.hpp"

/// Straight runs of an elbow that go along the target: a pipe support stands so on a bend.
namespace tubecut::joint {

/// Sine below which a leg runs along the target. The side of such a leg is no place to cut at: it
/// is looked at as far as `leg_reach`, and a leg that cuts the kept tube further away is refused.
inline constexpr double kAlongTarget = 0.01;
[[nodiscard]] inline double leg_reach(double radius, double bend_radius) {
  return 100.0 * (radius + bend_radius);
}

/// Does a leg go up along the surface of radius rho, so that it cuts it beyond that reach? The sine
/// of the angle between the two.
[[nodiscard]] std::optional<double> endless_leg(const PreparedElbow& elbow, double rho);

}  // namespace tubecut::joint
