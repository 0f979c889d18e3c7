#pragma once

#include <Eigen/Core>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/bevel/smoothing.hpp"

namespace tubecut::bevel {

/// The linear programme of the least area, in numbers near 1: heights in units of the range of B,
/// lengths in units of the mean spacing, cut open where the nodes are furthest apart.
struct Programme {
  Eigen::ArrayXd h, w, b;  // to the next node; weight in the area; B
  double slope = 0.0, curvature = 0.0, highest = 0.0;
  double unit = 1.0, pitch = 1.0;  // rad, mm
  Eigen::Index first = 0;          // the node of the profile that is node 0 here
  std::vector<char> keeps;         // nodes so far from every break of a limit that f is B there
  const AngleProfile& profile;     // what it came from
  const EnvelopeSpec& spec;

  /// Multipliers in the profile's own units and order.
  [[nodiscard]] Multipliers of_profile(Multipliers own) const;

  [[nodiscard]] Eigen::Index size() const { return b.size(); }
  [[nodiscard]] Eigen::Index next(Eigen::Index j) const { return j + 1 < size() ? j + 1 : 0; }
  [[nodiscard]] Eigen::Index previous(Eigen::Index j) const { return j > 0 ? j - 1 : size() - 1; }
};

/// A solution: heights in rad, none below B, and the multipliers that proved most on the way, those
/// of the profile.
struct Least {
  Eigen::ArrayXd heights;
  Multipliers multipliers;
};

/// Solves the programme, with f <= highest when `limited`, by a primal-dual interior point. Empty
/// when stopped or not converged. `Real`: what the Newton steps are reckoned in.
/// Source  Mehrotra, SIAM J. Optim. 2 (1992) 575; docs/theory/intersections-and-bevels.md, 6.3.
template <class Real>
[[nodiscard]] std::optional<Least> interior_point(const Programme& programme, bool limited,
                                                  const std::stop_token& stop);

}  // namespace tubecut::bevel
