#include "core/motion/timing/straight_move.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace tubecut::motion {
namespace {

/// The least time from rest to rest over a way of 1, by bisection on the speed reached: way and
/// time of a ramp to it are those of school.
double least_time(double v, double a, double j) {
  const auto ramp = [&](double speed) {  // s, to this speed
    return speed * j >= a * a ? speed / a + a / j : 2.0 * std::sqrt(speed / j);
  };
  if (v * ramp(v) <= 1.0) return 1.0 / v + ramp(v);
  double low = 0.0, high = v;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * ramp(middle) <= 1.0 ? low : high) = middle;
  }
  return 2.0 * ramp(low);
}

// Speed, acceleration and jerk by differences of only the distance, against the limits; the time
// against the minimum of all.
TEST(StraightMove, IsTheFastestWithinItsLimits) {
  std::mt19937_64 engine(21);
  std::uniform_real_distribution<double> power(-2.0, 2.0);
  constexpr int kSteps = 4000;
  for (int trial = 0; trial < 300; ++trial) {
    const double v = std::pow(10.0, power(engine)), a = std::pow(10.0, power(engine)),
                 j = std::pow(10.0, power(engine));
    const auto curve = SCurve::fastest(v, a, j);
    EXPECT_NEAR(curve.time(), least_time(v, a, j), 1e-9 * curve.time());
    EXPECT_EQ(curve.at(0.0), 0.0);
    EXPECT_EQ(curve.at(curve.time()), 1.0);
    const double h = curve.time() / kSteps;
    double first = 0.0, second = 0.0, third = 0.0;
    const auto at = [&](int k) { return curve.at(h * k); };
    for (int k = -3; k <= kSteps; ++k) {
      first = std::max(first, std::abs(at(k + 1) - at(k)));
      second = std::max(second, std::abs(at(k + 2) - 2 * at(k + 1) + at(k)));
      third = std::max(third, std::abs(at(k + 3) - 3 * at(k + 2) + 3 * at(k + 1) - at(k)));
    }
    const double noise = 1e-14;
    EXPECT_LE(first, v * h * (1 + 1e-9) + noise);
    EXPECT_LE(second, a * h * h * (1 + 1e-9) + noise);
    EXPECT_LE(third, j * h * h * h * (1 + 1e-9) + noise);
  }
}

TEST(StraightMove, WithoutJerkLimitsJumpsItsAcceleration) {
  EXPECT_DOUBLE_EQ(SCurve::fastest(2.0, 8.0, std::nullopt).time(), 0.5 + 0.25);
  EXPECT_DOUBLE_EQ(SCurve::fastest(100.0, 4.0, std::nullopt).time(), 1.0);
  EXPECT_DOUBLE_EQ(SCurve::fastest(100.0, 4.0, std::nullopt).at(0.25), 0.125);
}

// The slowest axis decides; the tip's speed if one is requested; nothing if nothing moves.
TEST(StraightMove, IsTimedByItsSlowestAxis) {
  Machine machine;
  machine.period = 0.004;
  machine.axes = {{.name = "X", .pulses_per_unit = 1000.0, .v_max = 100.0, .a_max = 1e6},
                  {.name = "Z", .pulses_per_unit = 1000.0, .v_max = 50.0, .a_max = 1e6}};
  EXPECT_FALSE(timed({.from = {1.0, 2.0}, .to = {1.0, 2.0}}, machine, true));
  EXPECT_NEAR(timed({.from = {0.0, 0.0}, .to = {100.0, 80.0}}, machine, true)->time(), 1.6, 1e-3);
  EXPECT_NEAR(
      timed({.from = {0.0, 0.0}, .to = {0.0, 30.0}, .length = 30.0, .speed = 10.0}, machine, true)
          ->time(),
      3.0, 1e-3);
  machine.axes[0].n_max = 40;  // of 400 a period at full speed
  EXPECT_NEAR(timed({.from = {0.0, 0.0}, .to = {100.0, 80.0}}, machine, true)->time(), 10.0, 1e-2);
}

}  // namespace
}  // namespace tubecut::motion
