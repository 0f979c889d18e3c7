#include "core/math/remez.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/cancelled.hpp"

namespace tubecut::math {
namespace {

SampledCurve curve(double (*f)(double), double from, double to) {
  SampledCurve out{f, chebyshev_grid(1601, from, to), {}};
  for (const double t : out.grid) out.values.push_back(f(t));
  return out;
}

// Degree 1 on 1/t over [1, 3] has a closed form: with u = p(t) t - 1 a parabola, |u| levels as the
// Chebyshev T_2.
TEST(Remez, ReciprocalByALineHasItsClosedForm) {
  const auto found = relative_minimax(curve([](double t) { return 1.0 / t; }, 1.0, 3.0), 1);
  ASSERT_TRUE(found);
  // u = t (a + b t) - 1 = E T_2(t - 2), u(0) = -1  =>  E (2 * 4 - 1) = -1
  EXPECT_NEAR(found->worst, 1.0 / 7.0, 1e-11);
  EXPECT_NEAR(found->level, 1.0 / 7.0, 1e-11);
}

TEST(Remez, ExponentialIsLevelledAtAlternatingPoints) {
  const auto f = [](double t) { return std::exp(t); };
  for (int degree = 0; degree <= 8; ++degree) {
    const auto found = relative_minimax(curve(f, -1.0, 1.0), degree);
    ASSERT_TRUE(found) << degree;
    ASSERT_EQ(found->reference.size(), static_cast<std::size_t>(degree) + 2);
    EXPECT_LE(found->worst - found->level, std::max(1e-9 * found->level, 5e-14)) << degree;
    EXPECT_LE(found->exchanges, 12);
    double sign = 0.0;
    for (const double t : found->reference) {
      const double error = value(found->series, t) / f(t) - 1.0;
      EXPECT_NEAR(std::abs(error), found->level, 1e-13 + 1e-8 * found->level);
      if (sign != 0.0 && found->level > 1e-12) {
        EXPECT_LT(sign * error, 0.0);
      }
      sign = error;
    }
  }
}

TEST(Remez, APolynomialIsItsOwnAnswer) {
  const auto found = relative_minimax(curve([](double t) { return 5.0 + t * t; }, 0.0, 4.0), 3);
  ASSERT_TRUE(found);
  EXPECT_LE(found->worst, kLevelledFloor);
}

TEST(Remez, StopsOnRequest) {
  const CancelledScope cancelled;
  const auto found = relative_minimax(curve([](double t) { return 2.0 + t; }, 0.0, 1.0), 2);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code(), ErrorCode::cancelled);
}

}  // namespace
}  // namespace tubecut::math
