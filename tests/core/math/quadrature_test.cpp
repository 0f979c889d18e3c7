#include "core/math/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tubecut::math {
namespace {

TEST(GaussLegendre, IntegratesEveryPowerItShould) {
  for (const int count : {1, 2, 5, 16, 64}) {
    const auto rule = gauss_legendre(count);
    for (int power = 0; power < 2 * count; ++power) {
      double sum = 0.0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        sum += rule.weights[i] * std::pow(rule.nodes[i], power);
      EXPECT_NEAR(sum, power % 2 == 0 ? 2.0 / (power + 1) : 0.0, 5e-15) << count << " " << power;
    }
  }
}

TEST(Legendre, HasTheClosedFormsOfLowDegree) {
  for (const double s : {-1.0, -0.3, 0.0, 0.7, 1.0}) {
    const auto p = legendre(3, s);
    EXPECT_NEAR(p[2], 1.5 * s * s - 0.5, 1e-15);
    EXPECT_NEAR(p[3], 2.5 * s * s * s - 1.5 * s, 1e-15);
  }
}

}  // namespace
}  // namespace tubecut::math
