#pragma once

// Smooths the bevel angle B along a closed path, so that the swing axis can follow.
//
// Idea: the result is never below B, because a smaller angle enters a partner. Of all curves within
// the limits of slope and curvature, `envelope` returns the one of least area, with multipliers
// that prove it.
//
// Example: one row of 30 deg in a path of 360 mm.
//     bevel::AngleProfile path{.s = {}, .b = std::vector<double>(360), .period = 360};
//     for (int i = 0; i < 360; ++i) path.s.push_back(i);
//     path.b[180] = 30 * kRadPerDeg;
//     const auto limits = bevel::bevel_rate_limits(0.8, 5, 10, 0.8).value();
//     const auto smooth = bevel::envelope(path, {limits}).value();
//     const double area = bevel::area_above(path, smooth.b);  // rad mm: 4.55

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"

/// Smooths the bevel angle B over one lap of the path, so that the swing axis can follow. Lengths
/// in mm, angles in radians.
///
/// Source    docs/theory/intersections-and-bevels.md, section 6.
namespace tubecut::bevel {

/// B at nodes of a closed path. The node after the last is the first, one period on.
struct AngleProfile {
  std::vector<double> s;  // mm along the path, strictly ascending, all within one period
  std::vector<double> b;  // rad
  double period = 0.0;    // mm, length of the closed path, > s.back() - s.front()
};

/// The limits of the swing axis at the speed of the cut.
struct BevelRateLimits {
  double slope = 0.0;      // K, rad/mm, > 0
  double curvature = 0.0;  // A, rad/mm^2, > 0: bound of the second divided difference
};

/// Computes the limits of a swing axis (rad/s, rad/s^2) whose path is cut at `speed` mm/s with the
/// fraction `use` of the axis: slope = use v / speed, curvature = use a / speed^2, along the true
/// length of the cut.
///
/// Errors  zero_limit (axis not above zero), out_of_range (speed not above zero, use outside (0,
///         1]).
[[nodiscard]] Result<BevelRateLimits> bevel_rate_limits(double velocity, double acceleration,
                                                        double speed, double use);

/// A step of B from sample `index` to the next (cyclic).
struct Mutation {
  std::size_t index = 0;
  double step = 0.0;  // rad, B after minus B before
};

/// Returns all steps with |step| > limit, ascending in index.
[[nodiscard]] std::vector<Mutation> mutations(std::span<const double> b, double limit);

/// Slopes and second divided differences (slope right - slope left) / ((h left + h right) / 2),
/// largest absolute values.
struct Steepness {
  double slope = 0.0;   // rad/mm
  double second = 0.0;  // rad/mm^2
};
[[nodiscard]] Steepness steepness(const AngleProfile& profile);

/// Returns the maximum steepness of a smoothed profile: its limits plus possible rounding.
[[nodiscard]] Steepness allowed_steepness(const AngleProfile& smoothed,
                                          const BevelRateLimits& limits);

/// Computes the area between `smoothed` and the profile, sum of (f_j - B_j)(h left + h right)/2,
/// rad*mm.
[[nodiscard]] double area_above(const AngleProfile& profile, std::span<const double> smoothed);

struct EnvelopeSpec {
  BevelRateLimits limits;
  double highest = std::numeric_limits<double>::infinity();  // rad, no B of the profile lies above
  bool refine = true;  // the least area; else the braking envelope
};

/// The value of each limit of a smoothed profile: multipliers of the linear programme of the least
/// area, one per node. Any values prove a bound (least_area.hpp); good values prove a good bound.
struct Multipliers {
  std::vector<double> contact;  // mm: of f >= B less that of f <= highest
  std::vector<double> slope;    // mm^2: of the slope after the node, |slope| <= K
};

struct Envelope {
  std::vector<double> b;    // rad
  Multipliers multipliers;  // empty without `refine`
};

/// Computes the smoothed bevel: f >= B at every node, |slope| <= K, |second difference| <= A, f <=
/// highest. With `refine` it has the least area; else it is the braking envelope. Always feasible.
///
/// Accuracy  f >= B and f <= highest exactly; slope within 1e-9 K + 4 eps max|f| / h_min, second
///           within 1e-6 A + 8 eps max|f| / h_min^2. Refined: area within 1e-6 of the minimum by
///           its own multipliers (10 000 hostile profiles; GLPK agrees on 200 nodes). If a node is
///           further than (max B - min B)/K + 4K/A from every node where B itself breaks a limit,
///           it keeps its bits; so does every node that B touches.
/// Errors    wrong_count, not_finite, out_of_range (order, period, limits, a B above `highest`),
///           cancelled.
/// Cost      linear without `refine`; with it each step of the search is linear, and 20 000 nodes
///           take some 30 steps. Every step checks `stopped()`.
/// Source    docs/theory/intersections-and-bevels.md, sections 6.2 and 6.3.
[[nodiscard]] Result<Envelope> envelope(const AngleProfile& profile, const EnvelopeSpec& spec);

struct HermiteSpec {
  double limit = 0.0;             // rad, steps above it are treated, > 0
  std::optional<int> transition;  // T in samples, 2..n/4; empty: for each window the smallest T
                                  // >= 1.5 |step| / limit
  std::vector<std::size_t> junctions =
      {};  // indices i of the steps i -> i+1 across a junction, ascending; only used without
           // `transition`; empty: the profile's mutations
};

/// One treated step. The window covers samples `from`, ..., `to` (cyclic, T steps); its inner
/// samples were replaced.
struct HermiteWindow {
  std::size_t index = 0;  // of the step index -> index + 1
  double step = 0.0;      // rad
  enum class Kept { before, after } kept = Kept::before;
  std::size_t from = 0;
  std::size_t to = 0;
  double slope_start = 0.0;  // rad/mm, the published one-sided end slopes
  double slope_end = 0.0;
};

struct HermiteSmoothed {
  std::vector<double> b;               // rad
  std::vector<HermiteWindow> windows;  // in order of treatment
};

/// Applies the published smoothing, corrected, for comparison: cubic windows next to each step
/// above the limit, largest first; the larger sample is kept. Guarantees neither f >= B nor any
/// slope.
///
/// Errors  wrong_count, not_finite, out_of_range (order, period, limit, transition),
///         sampling_not_uniform, smoothing_not_converged (200 windows), transition_too_long (no T
///         of its own fits), cancelled.
/// Cost    linear in the samples for each window, at most 200 windows.
/// Source  section 6.1.
[[nodiscard]] Result<HermiteSmoothed> hermite(const AngleProfile& profile, const HermiteSpec& spec);

/// Checks the preconditions on a profile that both methods share: counts, finite, ascending within
/// the period.
[[nodiscard]] Result<void> check_profile(const AngleProfile& profile);

}  // namespace tubecut::bevel
