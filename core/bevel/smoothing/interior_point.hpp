#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/bevel/smoothing/programme.hpp"

namespace tubecut::bevel {

/// A solution: heights in rad, at least B, and the multipliers of the best bound, those of the
/// profile.
struct Least {
  Eigen::ArrayXd heights;
  Multipliers multipliers;
};

/// Solves the programme, with f <= highest if `limited`, by a primal-dual interior point. Returns
/// empty when cancelled or not converged. `Numbers`: Pack runs along eight arcs of the ring at
/// once, whose joins lose digits if weights are 1e25 times others; double runs around it; long
/// double has more digits.
/// Source  Mehrotra, SIAM J. Optim. 2 (1992) 575; docs/theory/intersections-and-bevels.md, 6.3.
template <class Numbers>
[[nodiscard]] std::optional<Least> interior_point(const Programme& programme, bool limited);

}  // namespace tubecut::bevel
