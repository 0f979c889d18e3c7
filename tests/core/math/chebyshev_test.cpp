#include "core/math/chebyshev.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tubecut::math {
namespace {

ChebyshevSeries random_series(std::mt19937_64& random, int degree) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  ChebyshevSeries out{0.0, 1.0 + 50.0 * std::abs(any(random)), {}};
  for (int k = 0; k <= degree; ++k) out.coefficients.push_back(any(random));
  return out;
}

// T_k(s) = cos(k acos s): the definition, not the recurrence.
double by_definition(const ChebyshevSeries& series, double t) {
  const double s =
      std::min(1.0, std::max(-1.0, 2.0 * (t - series.from) / (series.to - series.from) - 1.0));
  double sum = 0.0;
  for (std::size_t k = 0; k < series.coefficients.size(); ++k)
    sum += series.coefficients[k] * std::cos(static_cast<double>(k) * std::acos(s));
  return sum;
}

TEST(Chebyshev, EveryFormIsTheSamePolynomial) {
  std::mt19937_64 random(1);
  for (int degree = 0; degree <= 8; ++degree) {
    const auto series = random_series(random, degree);
    const auto scaled = scaled_powers(series);
    const auto seconds = powers(series);
    for (int i = 0; i <= 100; ++i) {
      const double t = series.to * i / 100;
      const double want = by_definition(series, t);
      EXPECT_NEAR(value(series, t), want, 1e-13);
      EXPECT_NEAR(horner(scaled, 2.0 * t / series.to - 1.0), want, 1e-11);
      EXPECT_NEAR(horner(seconds, t), want, 1e-9);
    }
  }
}

TEST(Chebyshev, AntiderivativeStartsAtZeroAndHasTheSlope) {
  std::mt19937_64 random(2);
  for (int degree = 0; degree <= 8; ++degree) {
    const auto series = random_series(random, degree);
    const auto integral = antiderivative(series);
    EXPECT_NEAR(value(integral, 0.0), 0.0, 1e-13);
    const double h = 1e-5 * series.to;
    for (int i = 1; i < 20; ++i) {
      const double t = series.to * i / 20;
      EXPECT_NEAR((value(integral, t + h) - value(integral, t - h)) / (2.0 * h),
                  by_definition(series, t), 1e-6);
    }
  }
}

TEST(Chebyshev, InterpolantPassesThroughItsNodes) {
  const std::vector<double> nodes{0.0, 1.0, 2.5, 4.0, 7.0};
  const std::vector<double> values{1.0, -2.0, 0.5, 3.0, 2.0};
  const auto series = interpolant(nodes, values, 0.0, 7.0);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    EXPECT_NEAR(value(series, nodes[i]), values[i], 1e-12);
}

TEST(Search, GridIsAscendingWithExactEnds) {
  const auto grid = chebyshev_grid(1601, 0.0, 93.608);
  EXPECT_EQ(grid.front(), 0.0);
  EXPECT_EQ(grid.back(), 93.608);
  for (std::size_t i = 1; i < grid.size(); ++i) EXPECT_GT(grid[i], grid[i - 1]);
}

TEST(Search, FindsRootsAndMaxima) {
  EXPECT_NEAR(sign_change([](double x) { return x * x - 2.0; }, 0.0, 2.0), std::sqrt(2.0), 3e-16);
  EXPECT_NEAR(last_true([](double x) { return x * x <= 2.0; }, 0.0, 2.0), std::sqrt(2.0), 3e-16);
  const auto top = golden_maximum([](double x) { return 3.0 - (x - 0.3) * (x - 0.3); }, -1.0, 2.0);
  EXPECT_NEAR(top.value, 3.0, 1e-15);
}

}  // namespace
}  // namespace tubecut::math
