#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace tubecut::math {

/// Returns `count` (>= 2) Chebyshev-spaced points from `from` to `to`, ascending, both ends exact:
/// dense where polynomial errors oscillate fastest.
[[nodiscard]] std::vector<double> chebyshev_grid(std::size_t count, double from, double to);

/// Finds the point where `f` changes sign between `low` and `high` (f(low) and f(high) of opposite
/// sign, or one of them zero).
///
/// Accuracy  the last bracket is two neighbouring doubles, or 2^-128 of the first one.
/// Cost      at most 128 calls.
template <class F>
[[nodiscard]] double sign_change(F&& f, double low, double high) {
  const bool low_is_positive = f(low) > 0.0;
  for (int i = 0; i < 128; ++i) {
    const double middle = low + 0.5 * (high - low);
    if (middle == low || middle == high) break;
    ((f(middle) > 0.0) == low_is_positive ? low : high) = middle;
  }
  return low + 0.5 * (high - low);
}

/// Finds the largest `x` of [low, high] for which `holds` is true. `holds` must be true at `low`
/// and, once false, stay false.
/// Cost      at most 128 calls.
template <class Predicate>
[[nodiscard]] double last_true(Predicate&& holds, double low, double high) {
  for (int i = 0; i < 128; ++i) {
    const double middle = low + 0.5 * (high - low);
    if (middle == low || middle == high) break;
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

struct Extreme {
  double at = 0.0;
  double value = 0.0;
};

/// Finds the maximum of `f`, unimodal on [low, high], by golden section; never below the better of
/// the two inner points.
///
/// Accuracy  the bracket shrinks to 0.618^Steps of its width, by default 1e-8, so the value is good
///           to the square of it of the curve's drop over it.
/// Cost      Steps + 2 calls.
template <int Steps = 39, class F>
[[nodiscard]] Extreme golden_maximum(F&& f, double low, double high) {
  constexpr double kGolden = 0.6180339887498949;  // (sqrt(5) - 1) / 2
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  double at_left = f(left);
  double at_right = f(right);
  for (int i = 0; i < Steps; ++i) {
    if (at_left > at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = f(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = f(right);
    }
  }
  return at_left > at_right ? Extreme{left, at_left} : Extreme{right, at_right};
}

/// Finds the largest value of `f` over an ascending grid, refined between the neighbours of the
/// best grid point; `sampled` holds f at the grid. Ends count.
template <class F>
[[nodiscard]] Extreme grid_maximum(F&& f, const std::vector<double>& grid,
                                   const std::vector<double>& sampled) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < grid.size(); ++i)
    if (sampled[i] > sampled[best]) best = i;
  const double low = grid[best == 0 ? 0 : best - 1];
  const double high = grid[best + 1 == grid.size() ? best : best + 1];
  const Extreme refined = golden_maximum(f, low, high);
  return refined.value > sampled[best] ? refined : Extreme{grid[best], sampled[best]};
}

}  // namespace tubecut::math
