#include "core/cutoff/linkage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "tests/core/cutoff/machines.hpp"

namespace tubecut::cutoff {
namespace {

using testing::linkage_of;
using tubecut::testing::at;
using tubecut::testing::golden;
using tubecut::testing::number;

const api::Json& corpus() {
  static const api::Json json = golden("feed-curves.json");
  return json;
}

const api::Json::Array& rows(const api::Json& json, std::string_view path) {
  return *at(json, path).as<api::Json::Array>();
}

Mechanism mechanism(const Linkage& linkage) { return Mechanism::make(linkage).value(); }

void expect_relative(double got, double want, double bound) {
  EXPECT_NEAR(got, want, bound * std::abs(want));
}

class PublishedMachine : public ::testing::TestWithParam<const char*> {
 protected:
  const api::Json& json_ = at(corpus(), std::string("machines/") + GetParam());
  const Mechanism machine_ = mechanism(linkage_of(at(json_, "params")));
};

TEST_P(PublishedMachine, GridOfStrokesSpeedsAndAccelerations) {
  const auto& grid = rows(json_, "grid");
  ASSERT_EQ(grid.size(), 25u);
  double largest = 0.0;
  for (const auto& row : grid) largest = std::max(largest, std::abs(number(row, "g_second")));
  for (const auto& row : grid) {
    const double x = number(row, "x");
    const Inverse g = machine_.inverse(x);
    expect_relative(g.stroke, number(row, "y"), 1e-12);
    expect_relative(g.first, number(row, "g_prime"), 1e-12);
    EXPECT_NEAR(g.second, number(row, "g_second"), 1e-12 * largest) << x;
    expect_relative(machine_.forward(g.stroke).rate, number(row, "f_prime"), 1e-12);
    expect_relative(g.first * number(json_, "v"), number(row, "v_j"), 1e-12);
  }
}

TEST_P(PublishedMachine, ForwardFeeds) {
  ASSERT_GE(rows(json_, "forward").size(), 10u);
  for (const auto& row : rows(json_, "forward"))
    EXPECT_NEAR(machine_.tool_feed(number(row, "y")).value(), number(row, "x"),
                1e-12 * std::abs(number(row, "x")));
}

TEST_P(PublishedMachine, Geometry) {
  const auto& g = machine_.geometry();
  expect_relative(g.rod_height, number(json_, "x0"), 1e-14);
  expect_relative(g.slot_elevation.rad(), number(json_, "psi0"), 1e-14);
  expect_relative(g.stroke_low, number(json_, "y_lo"), 1e-13);
  expect_relative(g.stroke_high, number(json_, "y_hi"), 1e-13);
  expect_relative(g.feed_at_peak.value(), number(json_, "x_peak"), 1e-12);
  expect_relative(machine_.inverse(*g.feed_at_peak).first, number(json_, "g_prime_peak"), 1e-13);
  EXPECT_FALSE(g.feed_low);
  EXPECT_FALSE(g.feed_high);
}

// The principal arctangent of eq. (4) jumps where beta = 90 deg; nothing here may.
TEST_P(PublishedMachine, NoJumpAtTheArctangentsPole) {
  const double x = number(json_, "x_at_beta_90deg");
  const double step = 1e-9;
  const Inverse below = machine_.inverse(x - step);
  const Inverse above = machine_.inverse(x + step);
  EXPECT_NEAR(above.stroke - below.stroke, 2.0 * step * below.first, 1e-13);
  EXPECT_NEAR(machine_.forward(machine_.inverse(x).stroke).feed, x, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Golden, PublishedMachine, ::testing::Values("M1", "M2"));

TEST(ShortArm, GridAndLimits) {
  const auto& json = at(corpus(), "machines/R1_lt_R2");
  const auto machine = mechanism(linkage_of(at(json, "params")));
  const auto& g = machine.geometry();
  ASSERT_EQ(rows(json, "grid").size(), 3u);
  for (const auto& row : rows(json, "grid")) {
    const Inverse here = machine.inverse(number(row, "x"));
    expect_relative(here.stroke, number(row, "y"), 1e-12);
    expect_relative(here.first, number(row, "g_prime"), 1e-12);
  }
  EXPECT_FALSE(g.feed_low);
  expect_relative(g.feed_high.value(), number(json, "x_hi"), 1e-12);
  expect_relative(g.stroke_low, number(json, "y_lo"), 1e-12);
  expect_relative(g.stroke_high, number(json, "y_hi"), 1e-12);
  EXPECT_FALSE(machine.reaches(*g.feed_high + 1e-6));
  EXPECT_EQ(machine.tool_feed(g.stroke_high).error().code(), ErrorCode::dead_point);
  EXPECT_EQ(machine.tool_feed(g.stroke_low).error().code(), ErrorCode::tan_pole);
}

Linkage seeded(std::mt19937_64& random) {
  const auto any = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double distance = any(50.0, 2000.0);
  return {.arm = distance * any(0.4, 3.0),
          .pivot_distance = distance,
          .pivot_offset = distance * any(0.05, 1.0),
          .rest_angle = Angle::rad(any(-3.1, 3.1)),
          .slot_angle = Angle::rad(any(0.02, 3.12)),
          .rad_per_mm = any(1e-4, 1e-2)};
}

// 10^5 linkages: f(g(x)) = x within 1e-12 of |x| + A/cos^2 psi0, g rises, g' f' = 1; 1 % away from
// the limits.
TEST(SeededLinkages, InverseIsTheInverse) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> share(0.01, 0.99);
  int tried = 0;
  int short_arms = 0;
  double worst = 0.0;
  while (tried < 100'000) {
    const Linkage linkage = seeded(random);
    const auto made = Mechanism::make(linkage);
    if (!made) continue;
    ++tried;
    short_arms += linkage.arm < linkage.pivot_distance ? 1 : 0;
    const auto& g = made->geometry();
    const double cosine = std::cos(g.slot_elevation.rad());
    const double scale = linkage.pivot_offset / (cosine * cosine);
    double before = g.stroke_low;
    double x_before = -HUGE_VAL;
    double shares[] = {share(random), share(random), share(random)};
    std::sort(std::begin(shares), std::end(shares));
    for (const double at : shares) {
      // A fraction of the stroke, so that both limits stay 1 % away; the feed there is the input of
      // the inverse.
      const double x = made->forward(g.stroke_low + at * (g.stroke_high - g.stroke_low)).feed;
      const Inverse there = made->inverse(x);
      const Forward back = made->forward(there.stroke);
      const double error = std::abs(back.feed - x) / (std::abs(x) + scale);
      worst = std::max(worst, error);
      ASSERT_LE(error, 1e-12) << tried << " x " << x;
      ASSERT_NEAR(there.first * back.rate, 1.0, 1e-9);
      if (x > x_before) {
        ASSERT_GT(there.stroke, before);
      }
      ASSERT_GT(there.first, 0.0);
      before = there.stroke;
      x_before = x;
    }
    ASSERT_EQ(made->inverse(0.0).stroke, 0.0);
    ASSERT_EQ(made->forward(0.0).feed, 0.0);
  }
  EXPECT_GT(short_arms, 5'000);
  RecordProperty("worst", std::to_string(worst));
  std::printf("worst round trip %.3g, short arms %d\n", worst, short_arms);
}

// A cursor that goes to and fro, in small steps and in leaps, finds the strokes of the inverse.
TEST(SeededLinkages, CursorFollowsTheInverse) {
  std::mt19937_64 random(18);
  std::uniform_real_distribution<double> share(0.02, 0.98), size(-9.0, -0.5);
  for (int i = 0; i < 200;) {
    const auto made = Mechanism::make(seeded(random));
    if (!made) continue;
    ++i;
    const auto& g = made->geometry();
    const double width = g.stroke_high - g.stroke_low;
    StrokeCursor cursor(*made);
    double at = 0.5;
    for (int k = 0; k < 100; ++k) {
      const double step = std::pow(10.0, size(random)) * (share(random) < 0.5 ? -1.0 : 1.0);
      at = at + step > 0.02 && at + step < 0.98 ? at + step : share(random);
      const double feed = made->forward(g.stroke_low + at * width).feed;
      const Inverse got = cursor.at(feed), want = made->inverse(feed);
      ASSERT_NEAR(got.stroke, want.stroke, 1e-15 * 4.0 / g.rad_per_mm);
      ASSERT_EQ(got.first, want.first);
      ASSERT_EQ(got.second, want.second);
      ASSERT_EQ(got.third, want.third);
    }
  }
}

// Derivatives against central differences of the stroke itself.
TEST(SeededLinkages, DerivativesAreSlopes) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  for (int i = 0; i < 2'000;) {
    const auto made = Mechanism::make(seeded(random));
    if (!made) continue;
    ++i;
    const auto& g = made->geometry();
    const double x =
        made->forward(g.stroke_low + share(random) * (g.stroke_high - g.stroke_low)).feed;
    const double width = 1.0 / (made->inverse(x).first / (g.stroke_high - g.stroke_low));
    const double h = 1e-4 * std::min(width, made->pivot_offset());
    const Inverse low = made->inverse(x - h);
    const Inverse here = made->inverse(x);
    const Inverse high = made->inverse(x + h);
    ASSERT_NEAR((high.stroke - low.stroke) / (2.0 * h), here.first, 1e-4 * here.first);
    ASSERT_NEAR((high.first - low.first) / (2.0 * h), here.second, 1e-4 * here.first / h * 1e-2);
    ASSERT_NEAR((high.second - low.second) / (2.0 * h), here.third,
                1e-4 * here.first / (h * h) * 1e-4);
  }
}

TEST(Calibration, OneMeasuredPairGivesTheRate) {
  Linkage linkage = testing::table_3();
  const double stroke = mechanism(linkage).inverse(30.0).stroke;
  const double rate = std::exchange(linkage.rad_per_mm, 0.0);
  linkage.calibrate = MeasuredPair{30.0, stroke};
  const auto machine = mechanism(linkage);
  expect_relative(machine.geometry().rad_per_mm, rate, 1e-14);
  EXPECT_NEAR(machine.tool_feed(stroke).value(), 30.0, 1e-12);
}

TEST(Calibration, RefusesInvalidMeasurements) {
  Linkage linkage = testing::table_3();
  linkage.calibrate = MeasuredPair{30.0, 10.0};
  EXPECT_EQ(Mechanism::make(linkage).error().code(), ErrorCode::exclusive_fields);
  linkage.rad_per_mm = 0.0;
  linkage.calibrate = MeasuredPair{30.0, -10.0};
  EXPECT_EQ(Mechanism::make(linkage).error().issues.front().member, "linkage/calibrate/stroke");
  linkage.calibrate = MeasuredPair{0.0, 10.0};
  EXPECT_EQ(Mechanism::make(linkage).error().issues.front().member, "linkage/calibrate/feed");
}

TEST(Linkage, NamesEveryBadMember) {
  const Linkage bad{.arm = -1.0,
                    .pivot_distance = NAN,
                    .pivot_offset = 0.0,
                    .rest_angle = Angle::rad(4.0),
                    .slot_angle = Angle::rad(3.2),
                    .rad_per_mm = 0.0};
  const auto made = Mechanism::make(bad);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().issues.size(), 6u);
  EXPECT_EQ(made.error().issues[1].code, ErrorCode::not_finite);
  EXPECT_EQ(made.error().issues[1].member, "linkage/pivot_distance");
}

TEST(Linkage, StartsOnADeadPoint) {
  // rho = 2, theta0 chosen so that rho cos(gamma - theta0) = 1
  Linkage linkage{.arm = 100.0,
                  .pivot_distance = 200.0,
                  .pivot_offset = 60.0,
                  .slot_angle = Angle::rad(1.5),
                  .rad_per_mm = 0.001};
  linkage.rest_angle =
      Angle::rad(std::atan2(std::sqrt(200.0 * 200.0 - 3600.0), 60.0) - std::acos(0.5));
  EXPECT_EQ(Mechanism::make(linkage).error().code(), ErrorCode::dead_point);
}

}  // namespace
}  // namespace tubecut::cutoff
