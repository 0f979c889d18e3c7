#include "core/math/dome.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace tubecut::math {
namespace {

/// No point of the interval lies higher, and the dome is only refused where it has no point.
TEST(Dome, IsHighestWhereNoPointIsHigher) {
  std::mt19937 random(3);
  const auto drawn = [&](double from, double to) {
    return std::uniform_real_distribution<>(from, to)(random);
  };
  int refused = 0, ends = 0;
  for (int n = 0; n < 2000; ++n) {
    const Dome dome{drawn(-3, 3), drawn(0.2, 3), drawn(-1.5, 1.5), n % 9 == 0 ? 0.0 : drawn(-2, 2),
                    drawn(0.1, 1)};
    const double low = drawn(-2, 1), high = low + drawn(0, 2);
    double most = -std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 4000; ++i) {
      const double x = low + (high - low) * i / 4000;
      if (std::abs(dome.a + dome.b * x) < dome.h) most = std::max(most, dome.at(x));
    }
    const auto top = highest(dome, low, high);
    if (!top) {
      EXPECT_EQ(most, -std::numeric_limits<double>::infinity());
      ++refused;
      continue;
    }
    EXPECT_GE(*top, low);
    EXPECT_LE(*top, high);
    EXPECT_GE(dome.at(*top), most - 1e-12);
    // Up to the steep side of the circle, between two points.
    if (std::isfinite(most)) {
      EXPECT_LE(dome.at(*top), most + 0.3);
    }
    ends += *top == low || *top == high;
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(ends, 100);
}

}  // namespace
}  // namespace tubecut::math
