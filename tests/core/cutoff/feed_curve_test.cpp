#include "core/cutoff/feed_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "core/cutoff/verify.hpp"
#include "tests/core/cutoff/machines.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::cutoff {
namespace {

using tubecut::testing::at;
using tubecut::testing::golden;
using tubecut::testing::text;

FeedCurveSpec small_request() {
  auto spec = testing::table_3_request();
  spec.cycle->period = 0.01;
  return spec;
}

/// Sets one member of the golden file's error cases.
void change(FeedCurveSpec& spec, const std::string& name, double value) {
  auto& l = spec.linkage;
  auto& cut = std::get<CutDistances>(spec.cut.range);
  const std::map<std::string, std::function<void()>> set{
      {"R1", [&] { l.arm = value; }},
      {"A", [&] { l.pivot_offset = value; }},
      {"k", [&] { l.rad_per_mm = value; }},
      {"alpha", [&] { l.slot_angle = Angle::rad(value); }},
      {"theta0", [&] { l.rest_angle = Angle::rad(value); }},
      {"s1", [&] { cut.clearance = value; }},
      {"s2", [&] { cut.slowdown = value; }},
      {"s", [&] { cut.wall = value; }},
      {"v", [&] { spec.cut.feed = value; }},
      {"cyl_v_max", [&] { spec.cycle->max_cylinder_speed = value; }},
      {"Ts", [&] { spec.cycle->period = value; }}};
  set.at(name)();
}

TEST(GoldenErrors, EveryCode) {
  const auto json = golden("feed-curves.json");
  const auto& rows = *at(json, "errors").as<api::Json::Array>();
  ASSERT_EQ(rows.size(), 19u);
  int seen = 0;
  for (const auto& row : rows) {
    const auto base = text(row, "base");
    const auto want = text(row, "code");
    if (want == "not_a_number") continue;  // the reader's own: core never sees a text
    const auto& [name, node] = at(row, "change").as<api::Json::Object>()->front();
    SCOPED_TRACE(base + " " + name + " " + want);
    const double value = *node.as<double>();
    ++seen;
    auto spec = small_request();
    if (base == "M1") spec.linkage = testing::table_1();
    if (name == "y") {
      const auto stroke = Mechanism::make(spec.linkage)->tool_feed(value);
      ASSERT_FALSE(stroke);
      EXPECT_EQ(info(stroke.error().code()).code, want);
      continue;
    }
    change(spec, name, value);
    const auto out = feed_curve(spec);
    ASSERT_FALSE(out);
    EXPECT_EQ(info(out.error().code()).code, want);
    EXPECT_FALSE(out.error().issues.front().member.empty());
  }
  EXPECT_EQ(seen, 17);
}

TEST(Errors, BeyondTheGoldenFile) {
  const auto code = [](const std::function<void(FeedCurveSpec&)>& edit) {
    auto spec = small_request();
    edit(spec);
    const auto out = feed_curve(spec);
    return out ? ErrorCode::internal_error : out.error().code();
  };
  EXPECT_EQ(code([](auto& s) { s.tube->wall = 97.0; }), ErrorCode::wall_too_thick);
  EXPECT_EQ(code([](auto& s) { s.cycle->max_cylinder_acceleration = 0.01; }),
            ErrorCode::work_accel_above_limit);
  EXPECT_EQ(code([](auto& s) { s.cycle->max_cylinder_jerk = 1e-5; }),
            ErrorCode::work_accel_above_limit);
  EXPECT_EQ(code([](auto& s) { s.cycle->handling = -1.0; }), ErrorCode::out_of_range);
  EXPECT_EQ(code([](auto& s) { s.cut.range = FeedWindow{20.0, 10.0}; }), ErrorCode::out_of_range);
  EXPECT_EQ(code([](auto& s) { s.cut.range = FeedWindow{NAN, 10.0}; }), ErrorCode::not_finite);
  EXPECT_EQ(code([](auto& s) { s.table = TablePoints{1}; }), ErrorCode::out_of_range);
  EXPECT_EQ(code([](auto& s) { s.table = TableStep{0.0}; }), ErrorCode::out_of_range);
  EXPECT_EQ(code([](auto& s) { s.table = TableStep{1e-6}; }), ErrorCode::out_of_range);
  EXPECT_EQ(code([](auto& s) { s.comparison = ComparisonSpec{4, 9}; }), ErrorCode::out_of_range);
  EXPECT_EQ(code([](auto& s) {
              s.linkage = {.arm = 200,
                           .pivot_distance = 268,
                           .pivot_offset = 56,
                           .rest_angle = Angle::rad(0.3),
                           .slot_angle = Angle::rad(2.9),
                           .rad_per_mm = 0.002};
            }),
            ErrorCode::unreachable_x);  // its feed ends at 19.46 mm, this cut at 25
  const CancelledScope cancelled;
  EXPECT_EQ(feed_curve(small_request()).error().code(), ErrorCode::cancelled);
}

TEST(Table, ByPointsAndBySteps) {
  auto spec = small_request();
  spec.cycle.reset();
  spec.table = TablePoints{11};
  const auto points = feed_curve(spec)->table;
  ASSERT_EQ(points.time.size(), 11u);
  EXPECT_EQ(points.feed.front(), 10.0);
  EXPECT_EQ(points.feed.back(), 25.0);
  EXPECT_NEAR(points.time[5], 7.5, 1e-14);
  spec.table = TableStep{0.1};
  const auto steps = feed_curve(spec)->table;
  ASSERT_EQ(steps.feed.size(), 151u);
  EXPECT_NEAR(steps.feed[37], 13.7, 1e-12);
  EXPECT_EQ(steps.feed.back(), 25.0);
  spec.table = TableStep{4.0};
  const auto uneven = feed_curve(spec)->table;
  ASSERT_EQ(uneven.feed.size(), 5u);
  EXPECT_EQ(uneven.feed[3], 22.0);
  EXPECT_EQ(uneven.feed[4], 25.0);
}

TEST(FeedCurve, OptionalSectionsArePresentIfRequested) {
  auto spec = small_request();
  const auto all = feed_curve(spec).value();
  EXPECT_TRUE(all.cycle && all.tool && all.comparison);
  EXPECT_EQ(all.comparison->size(), 13u);
  ASSERT_EQ(all.warnings.size(), 2u);  // the window; 10..25 mm is before the peak of the speed
  EXPECT_EQ(all.warnings[0].code, WarningCode::polynomial_window);
  EXPECT_EQ(all.warnings[1].code, WarningCode::monotone_work_range);
  spec.cycle.reset();
  spec.tool.reset();
  spec.comparison.reset();
  const double wall = std::get<CutDistances>(spec.cut.range).wall;
  spec.tube = TubeSpec{300.0, wall};
  const auto bare = feed_curve(spec).value();
  EXPECT_FALSE(bare.cycle || bare.tool || bare.comparison);
  ASSERT_EQ(bare.warnings.size(), 3u);
  EXPECT_EQ(bare.warnings[2].code, WarningCode::tube_outside_range);
  spec.tube->wall = 2.0 * wall;
  EXPECT_EQ(feed_curve(spec).error().code(), ErrorCode::unsupported_combination);
}

// y, speeds and the peak depend on k only by a factor 1/k: the metamorphic law of the spec.
TEST(FeedCurve, ScalesAsOneOverK) {
  auto spec = small_request();
  spec.cycle.reset();
  const auto one = feed_curve(spec).value();
  spec.linkage.rad_per_mm *= 0.5;
  const auto two = feed_curve(spec).value();
  EXPECT_EQ(two.geometry.feed_at_peak, one.geometry.feed_at_peak);
  for (std::size_t i = 0; i < one.table.time.size(); ++i) {
    EXPECT_EQ(two.table.stroke[i], 2.0 * one.table.stroke[i]);
    EXPECT_EQ(two.table.speed[i], 2.0 * one.table.speed[i]);
  }
  EXPECT_NEAR(two.fit.errors.max_relative_error, one.fit.errors.max_relative_error, 1e-12);
}

TEST(Verify, GoodAnswersPass) {
  std::mt19937_64 random(9);
  const auto any = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::map<std::string, double> worst;  // share of the limit
  int answered = 0;
  for (int i = 0; i < 300; ++i) {
    auto spec = small_request();
    const double distance = any(50.0, 2000.0);
    spec.linkage = {.arm = distance * any(0.4, 3.0),
                    .pivot_distance = distance,
                    .pivot_offset = distance * any(0.05, 1.0),
                    .rest_angle = Angle::rad(any(-3.1, 3.1)),
                    .slot_angle = Angle::rad(any(0.02, 3.12)),
                    .rad_per_mm = any(1e-4, 1e-2)};
    if (i < 20) spec.linkage = i % 2 == 0 ? testing::table_1() : testing::table_3();
    const double clearance = any(1.0, 15.0);
    spec.cut = {CutDistances{clearance, any(0.0, 1.0) * clearance, any(3.0, 40.0), any(0.0, 4.0)},
                any(0.3, 4.0)};
    spec.tube->wall = std::get<CutDistances>(spec.cut.range).wall;
    constexpr FitMethod kMethods[] = {FitMethod::minimax, FitMethod::least_squares,
                                      FitMethod::three_point, FitMethod::automatic};
    spec.fit.method = kMethods[i % 4];
    spec.fit.degree = i % 4 == 2 ? 2 : 1 + i % 8;
    spec.fit.preserve_stroke = i % 3 == 0;
    spec.table = TablePoints{50};
    spec.comparison = i % 10 == 0 ? std::optional(ComparisonSpec{2, 3}) : std::nullopt;
    spec.cycle->max_feed.reset();
    spec.cycle->max_cylinder_speed = any(50.0, 500.0);
    spec.cycle->period = any(0.002, 0.05);
    if (i % 5 == 0) spec.cycle.reset();
    auto out = feed_curve(spec);
    if (!out && spec.cycle) {
      spec.cycle.reset();
      out = feed_curve(spec);
    }
    if (!out) {
      EXPECT_NE(out.error().code(), ErrorCode::not_converged) << i;
      continue;
    }
    ++answered;
    for (const auto& check : verify(spec, *out)) {
      EXPECT_TRUE(check.passed()) << i << " " << check.name << " " << check.value << " > "
                                  << check.limit;
      auto& share = worst[check.name];
      if (check.limit > 0.0) share = std::max(share, check.value / check.limit);
    }
  }
  EXPECT_GT(answered, 60);
  std::printf("%d answers\n", answered);
  for (const auto& [name, share] : worst) std::printf("  %s %.2g\n", name.c_str(), share);
}

// Every check fails when the one number it guards is off by ten times its limit.
TEST(Verify, EveryCheckSeesTenTimesItsLimit) {
  auto spec = small_request();
  const auto middle = [](std::vector<double>& column) -> double& {
    return column[column.size() / 2];
  };
  spec.linkage.calibrate = MeasuredPair{30.0, Mechanism::make(spec.linkage)->inverse(30.0).stroke};
  spec.linkage.rad_per_mm = 0.0;
  const auto good = feed_curve(spec).value();
  using Corrupt = std::function<void(FeedCurve&, double)>;  // the second is ten times the limit
  const auto cruise = [](const FeedCurve& c) {              // a sample at the approach's peak
    std::size_t i = 0;
    while (c.cycle->samples.speed[i] < c.cycle->approach_peak) ++i;
    return i;
  };
  const std::map<std::string, Corrupt> corruptions{
      {"stroke_limits",
       [](FeedCurve& c, double x) { c.geometry.stroke_high += x / c.geometry.rad_per_mm; }},
      {"peak_feed", [](FeedCurve& c, double x) { *c.geometry.feed_at_peak += x * 1000.0; }},
      {"work_ends", [](FeedCurve& c, double x) { c.work.end_stroke += x * 1000.0; }},
      {"calibration", [](FeedCurve& c, double x) { c.geometry.rad_per_mm *= 1.0 + 10.0 * x; }},
      {"table_feed", [&](FeedCurve& c, double x) { middle(c.table.feed) += x * 120.0; }},
      {"table_speed", [&](FeedCurve& c, double x) { middle(c.table.speed) *= 1.0 + x; }},
      {"table_acceleration",
       [&](FeedCurve& c, double x) { middle(c.table.acceleration) *= 1.0 + 100.0 * x; }},
      {"table_pace", [&](FeedCurve& c, double x) { middle(c.table.time) += x * 35.0; }},
      {"work_speed", [](FeedCurve& c, double x) { c.work.max_cylinder_speed *= 1.0 + x; }},
      {"work_acceleration",
       [](FeedCurve& c, double x) { c.work.max_cylinder_acceleration *= 1.0 + x; }},
      {"fit_forms", [](FeedCurve& c, double x) { c.fit.scaled[0] *= 1.0 + x; }},
      {"fit_speed_error",
       [](FeedCurve& c, double x) { c.fit.errors.max_relative_error *= 1.0 - x; }},
      {"fit_rounded", [](FeedCurve& c, double x) { c.fit.rounded_max_relative_error *= 1.0 - x; }},
      {"fit_tool_ripple", [](FeedCurve& c, double x) { c.fit.errors.tool_ripple *= 1.0 - x; }},
      {"fit_tool_position",
       [](FeedCurve& c, double x) { c.fit.errors.tool_position_error *= 1.0 - x; }},
      {"fit_end_drift", [](FeedCurve& c, double x) { c.fit.errors.end_drift += x * 120.0; }},
      {"comparison_minimax",
       [](FeedCurve& c, double x) {
         auto& rows = *c.comparison;  // equispaced and minimax of degree 2
         rows[3].errors.max_relative_error = rows[1].errors.max_relative_error * (1.0 + x);
       }},
      {"cycle_speed",
       [&](FeedCurve& c, double x) { c.cycle->samples.speed[cruise(c)] = 150.0 * (1.0 + x); }},
      {"cycle_acceleration",
       [](FeedCurve& c, double x) { c.cycle->samples.acceleration[3] = 800.0 * (1.0 + x); }},
      {"cycle_jerk",
       [](FeedCurve& c, double x) { c.cycle->samples.acceleration[200] += x * 20000.0 * 0.01; }},
      {"cycle_speed_steps",
       [](FeedCurve& c, double x) {
         c.cycle->samples.speed[200] += x * 20000.0 * 0.01 * 0.01 / 4.0;
       }},
      {"cycle_stroke_steps",
       [](FeedCurve& c, double x) { c.cycle->samples.stroke[200] += x * 20000.0 * 1e-6 / 12.0; }},
      {"cycle_max_feed", [](FeedCurve& c, double x) { c.cycle->stop_feed = 39.0 * (1.0 + x); }},
      {"cycle_feed", [&](FeedCurve& c, double x) { middle(c.cycle->samples.feed) += x * 300.0; }},
      {"cycle_feed_speed",
       [&](FeedCurve& c, double x) { middle(c.cycle->samples.feed_speed) += x * 35.0; }},
      {"cycle_times", [](FeedCurve& c, double x) { c.cycle->pieces_per_hour *= 1.0 + x; }},
      {"cycle_ends_at_rest", [](FeedCurve& c, double) { c.cycle->samples.stroke.back() = 1e-300; }},
      {"cycle_target_estimate",
       [](FeedCurve& c, double x) { *c.cycle->target->estimated_feed *= 1.0 + 3.0 * x; }},
      {"tool_feed", [](FeedCurve& c, double x) { c.tool->feed_per_blade_low *= 1.0 + 2.0 * x; }},
      {"tool_roughness", [](FeedCurve& c, double x) { c.tool->roughness *= 1.0 + x; }},
      {"tool_wall_cut", [](FeedCurve& c, double x) { c.tool->wall_cut->chip_volume *= 1.0 + x; }},
  };
  const auto checks = verify(spec, good);
  EXPECT_EQ(checks.size(), corruptions.size());
  for (const auto& check : checks) {
    EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " > " << check.limit;
    ASSERT_TRUE(corruptions.contains(check.name)) << check.name;
    FeedCurve bad = good;
    corruptions.at(check.name)(bad, 10.0 * check.limit);
    const auto again = verify(spec, bad);
    const auto seen = std::find_if(again.begin(), again.end(),
                                   [&](const Check& c) { return c.name == check.name; });
    ASSERT_NE(seen, again.end());
    EXPECT_FALSE(seen->passed()) << check.name << " " << seen->value << " <= " << seen->limit;
    FeedCurve none = good;
    corruptions.at(check.name)(none, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(std::ranges::all_of(verify(spec, none), &Check::passed))
        << check.name << " of NaN";
  }
}

}  // namespace
}  // namespace tubecut::cutoff
