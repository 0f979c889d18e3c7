#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "core/base/error.hpp"
#include "core/math/chebyshev.hpp"

namespace tubecut::math {

/// A positive curve with its values on an ascending grid that starts and ends the interval.
struct SampledCurve {
  std::function<double(double)> at;
  std::vector<double> grid;
  std::vector<double> values;
};

struct RelativeMinimax {
  ChebyshevSeries series;
  double level = 0.0;                  // |p/f - 1| at the reference points
  double worst = 0.0;                  // largest |p/f - 1| found on the interval
  std::vector<double> reference = {};  // degree + 2 points, signs alternate
  int exchanges = 0;
};

/// The levelling Remez stops at, and the rounding floor of p/f - 1 below which nothing can be
/// levelled.
inline constexpr double kLevelled = 1e-10;
inline constexpr double kLevelledFloor = 5e-14;

/// The polynomial of `degree` (0..8) with the smallest largest relative error p/f - 1: Remez
/// exchange of all extrema.
///
/// Errors    cancelled; not_converged when 60 exchanges do not level a curve (none seen; at most 5
///           needed by the golden curves).
/// Accuracy  worst <= level (1 + kLevelled) or worst - level <= kLevelledFloor.
/// Cost      one pass over the grid an exchange, and 41 calls of the curve an extremum.
/// Source    docs/theory/feed-curves.md, section 4.
[[nodiscard]] Result<RelativeMinimax> relative_minimax(const SampledCurve& curve, int degree,
                                                       std::stop_token stop = {});

}  // namespace tubecut::math
