#include "core/math/search.hpp"

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::math {

std::vector<double> chebyshev_grid(std::size_t count, double from, double to) {
  std::vector<double> grid(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double half_turn = 0.5 * kPi * static_cast<double>(i) / static_cast<double>(count - 1);
    const double sine =
        elementary::sin(half_turn);  // (1 - cos 2x)/2 = sin^2 x: no cancellation at `from`
    grid[i] = from + (to - from) * sine * sine;
  }
  grid.front() = from;
  grid.back() = to;
  return grid;
}

}  // namespace tubecut::math
