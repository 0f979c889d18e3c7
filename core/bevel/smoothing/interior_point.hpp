#pragma once

#include <Eigen/Core>
#include <optional>
#include <stop_token>

#include "core/bevel/smoothing/programme.hpp"

namespace tubecut::bevel {

/// A solution: heights in rad, none below B, and the multipliers that proved most on the way, those
/// of the profile.
struct Least {
  Eigen::ArrayXd heights;
  Multipliers multipliers;
};

/// Solves the programme, with f <= highest when `limited`, by a primal-dual interior point. Empty
/// when stopped or not converged. `Numbers`: Pack goes along eight arcs of the ring at once, whose
/// joins lose digits where weights are 1e25 times others; double goes round it; long double has
/// more digits.
/// Source  Mehrotra, SIAM J. Optim. 2 (1992) 575; docs/theory/intersections-and-bevels.md, 6.3.
template <class Numbers>
[[nodiscard]] std::optional<Least> interior_point(const Programme& programme, bool limited,
                                                  const std::stop_token& stop);

}  // namespace tubecut::bevel
