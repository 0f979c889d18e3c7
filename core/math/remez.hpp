#pragma once

#include <functional>
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

/// The accuracy of the levelling at which Remez stops, and the rounding floor of p/f - 1 below
/// which levelling is impossible.
inline constexpr double kLevelled = 1e-10;
inline constexpr double kLevelledFloor = 5e-14;

/// Computes the polynomial of `degree` (0..8) with the smallest largest relative error p/f - 1, by
/// Remez exchange of all extrema.
///
/// Errors    cancelled; not_converged if 60 exchanges do not level a curve (never seen; the golden
///           curves need at most 5).
/// Accuracy  worst <= level (1 + kLevelled) or worst - level <= kLevelledFloor.
/// Cost      one pass over the grid an exchange, and 41 calls of the curve an extremum.
/// Source    docs/theory/feed-curves.md, section 4.
[[nodiscard]] Result<RelativeMinimax> relative_minimax(const SampledCurve& curve, int degree);

}  // namespace tubecut::math
