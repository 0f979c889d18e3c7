#include "core/cutoff/cycle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/core/cutoff/machines.hpp"

namespace tubecut::cutoff {
namespace {

using tubecut::testing::at;
using tubecut::testing::golden;
using tubecut::testing::number;
using tubecut::testing::numbers;

double or_zero(const api::Json& json, std::string_view name) {
  return json.find(name) ? number(json, name) : 0.0;
}

struct Case {
  WorkFeed work;
  CycleSpec spec;
};

Case case_of(const api::Json& row) {
  const auto& r = at(row, "request");
  const Cut cut{CutDistances{number(r, "s1"), number(r, "s2"), number(r, "s"), number(r, "s3")},
                number(r, "v")};
  const CycleSpec spec{.period = 0.002,
                       .max_cylinder_speed = number(r, "cyl_v_max"),
                       .max_cylinder_acceleration = number(r, "cyl_a_max"),
                       .max_cylinder_jerk = number(r, "cyl_j_max"),
                       .max_feed = number(r, "max_feed"),
                       .dwell = or_zero(r, "dwell"),
                       .handling = number(r, "handling"),
                       .target = number(r, "target_rate")};
  return {
      WorkFeed::make(Mechanism::make(testing::linkage_of(at(row, "machine"))).value(), cut).value(),
      spec};
}

TEST(GoldenCycles, EveryFigureAndSample) {
  const auto json = golden("feed-curves.json");
  const auto& rows = *at(json, "cycle").as<api::Json::Array>();
  ASSERT_EQ(rows.size(), 3u);
  for (const auto& row : rows) {
    const auto [work, spec] = case_of(row);
    const auto c = cycle(work, spec).value();
    const auto& want = at(row, "result");
    const auto near = [&want](double got, const char* name) {
      EXPECT_NEAR(got, number(want, name), 1e-12 * std::abs(number(want, name)) + 1e-12) << name;
    };
    near(work.work().start_feed, "x_s");
    near(work.work().end_feed, "x_e");
    near(work.work().start_stroke, "y_s");
    near(work.work().end_stroke, "y_e");
    near(work.work().min_cylinder_speed, "vj_min");
    near(work.work().max_cylinder_speed, "vj_max");
    near(c.stop_feed, "x_stop");
    near(c.overshoot, "tool_overshoot");
    near(c.stop_stroke, "y_stop");
    near(c.work_start, "t1");
    near(c.work_end, "t2");
    near(c.stop, "t_stop");
    near(c.end, "t3");
    near(c.cycle, "cycle");
    near(c.pieces_per_hour, "pieces_per_hour");
    near(c.speed_in, "v_handover_in");
    near(c.speed_out, "v_handover_out");
    near(c.acceleration_step_in, "accel_step_in");
    near(c.acceleration_step_out, "accel_step_out");
    near(c.approach_peak, "peak_speed_approach");
    near(c.return_peak, "peak_speed_return");
    near(c.target->estimated_feed.value(), "v_for_target");
    EXPECT_EQ(c.target->met, *at(want, "target_met").as<bool>());
    ASSERT_EQ(c.samples.time.size(), static_cast<std::size_t>(number(want, "n_samples")));
    const auto index = numbers(want, "sample_index");
    const auto column = [&](const std::vector<double>& got, const char* name, double bound) {
      const auto sampled = numbers(want, std::string("sampled/") + name);
      ASSERT_EQ(sampled.size(), index.size());
      for (std::size_t i = 0; i < index.size(); ++i)
        EXPECT_NEAR(got[static_cast<std::size_t>(index[i])], sampled[i], bound) << name << " " << i;
    };
    column(c.samples.time, "t", 1e-12);
    column(c.samples.stroke, "y", 1e-11);
    column(c.samples.speed, "vy", 1e-11);
    column(c.samples.acceleration, "ay", 1e-9);
    column(c.samples.feed, "x", 1e-11);
    column(c.samples.feed_speed, "vx", 1e-11);
  }
}

// The spec's two figures for the feed with the ramps planned again.
TEST(GoldenCycles, FeedForTarget) {
  const auto json = golden("feed-curves.json");
  const double want[] = {0.815147, 1.611773};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto [work, spec] = case_of(at(json, "cycle/" + std::to_string(i)));
    const auto c = cycle(work, spec).value();
    EXPECT_NEAR(c.target->feed.value(), want[i], 0.5e-6);
    const auto& w = work.work();
    const auto again =
        WorkFeed::make(work.mechanism(), {FeedWindow{w.start_feed, w.end_feed}, *c.target->feed})
            .value();
    EXPECT_NEAR(cycle(again, spec)->pieces_per_hour, 120.0, 1e-9);
  }
}

TEST(Cycle, UnreachableTargetHasNoFeed) {
  auto spec = testing::cycle_limits();
  spec.target = 400.0;  // 9 s a piece, but handling takes 10
  const auto work =
      WorkFeed::make(Mechanism::make(testing::table_3()).value(), {CutDistances{12, 2, 10, 3}, 1.0})
          .value();
  const auto c = cycle(work, spec).value();
  EXPECT_FALSE(c.target->met);
  EXPECT_FALSE(c.target->estimated_feed);
  EXPECT_FALSE(c.target->feed);
}

/// Speed continuous; speed, acceleration and jerk within the limits at every sample and between,
/// but for the two reported acceleration steps. `fine` has been sampled several times a servo
/// period, so "between" is seen too.
void expect_within_limits(const WorkFeed& work, const CycleSpec& spec, const Cycle& c) {
  const auto& s = c.samples;
  const double eps = 1e-9;
  ASSERT_GE(s.time.size(), 3u);
  EXPECT_EQ(s.time.back(), c.end);
  EXPECT_EQ(s.stroke.back(), 0.0);
  EXPECT_EQ(s.speed.back(), 0.0);
  EXPECT_EQ(s.acceleration.back(), 0.0);
  EXPECT_EQ(s.feed.back(), 0.0);
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    ASSERT_LE(std::abs(s.speed[i]), spec.max_cylinder_speed * (1.0 + eps));
    ASSERT_LE(std::abs(s.acceleration[i]), spec.max_cylinder_acceleration * (1.0 + eps));
    if (i == 0) continue;
    const double h = s.time[i] - s.time[i - 1];
    ASSERT_GT(h, 0.0);
    const bool hand_over = (s.time[i - 1] <= c.work_start && s.time[i] >= c.work_start) ||
                           (s.time[i - 1] <= c.work_end && s.time[i] >= c.work_end);
    const double step = hand_over ? std::max(c.acceleration_step_in, c.acceleration_step_out) : 0.0;
    ASSERT_LE(
        std::abs(s.acceleration[i] - s.acceleration[i - 1]),
        spec.max_cylinder_jerk * h * (1.0 + eps) + step + eps * spec.max_cylinder_acceleration)
        << s.time[i];
    const double most = std::max(std::abs(s.acceleration[i]), std::abs(s.acceleration[i - 1])) +
                        spec.max_cylinder_jerk * h + step;
    ASSERT_LE(std::abs(s.speed[i] - s.speed[i - 1]), most * h + 1e-11) << s.time[i];
    ASSERT_NEAR(s.stroke[i] - s.stroke[i - 1], 0.5 * h * (s.speed[i] + s.speed[i - 1]),
                spec.max_cylinder_jerk * h * h * h / 12 + step * h * h / 8 + 1e-11)
        << s.time[i];
    if (spec.max_feed) {
      ASSERT_LE(s.feed[i], *spec.max_feed);
    }
    if (s.time[i] >= c.work_start && s.time[i] <= c.work_end) {
      ASSERT_EQ(s.feed_speed[i], work.work().feed);
    }
  }
}

TEST(Cycle, LimitsHoldAtAndBetweenSamples) {
  const auto json = golden("feed-curves.json");
  for (const auto& row : *at(json, "cycle").as<api::Json::Array>()) {
    auto [work, spec] = case_of(row);
    for (const double period : {0.002, 0.002 / 7.0}) {
      spec.period = period;
      expect_within_limits(work, spec, cycle(work, spec).value());
    }
  }
}

// Short moves, slow limits, ramps with and without constant acceleration.
TEST(Cycle, LimitsHoldOnSeededCycles) {
  std::mt19937_64 random(7);
  const auto any = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int planned = 0;
  for (int i = 0; i < 400; ++i) {
    const auto linkage = i % 2 == 0 ? testing::table_1() : testing::table_3();
    const double clearance = any(0.5, 20.0);
    const Cut cut{CutDistances{clearance, any(0.0, clearance), any(1.0, 15.0), any(0.0, 4.0)},
                  any(0.5, 5.0)};
    CycleSpec spec{.period = any(0.001, 0.02),
                   .max_cylinder_speed = any(10.0, 400.0),
                   .max_cylinder_acceleration = any(10.0, 3000.0),
                   .max_cylinder_jerk = any(200.0, 1e5),
                   .dwell = i % 3 == 0 ? any(0.0, 1.0) : 0.0,
                   .handling = 5.0,
                   .target = any(60.0, 400.0)};
    const auto work = WorkFeed::make(Mechanism::make(linkage).value(), cut).value();
    const auto c = cycle(work, spec);
    if (!c) {
      EXPECT_TRUE(c.error().code() == ErrorCode::work_speed_above_limit ||
                  c.error().code() == ErrorCode::approach_too_short);
      continue;
    }
    ++planned;
    ASSERT_NO_FATAL_FAILURE(expect_within_limits(work, spec, *c));
    if (!c->target->feed) {
      EXPECT_FALSE(c->target->met);
      continue;
    }
    const auto& w = work.work();
    const auto again =
        WorkFeed::make(work.mechanism(), {FeedWindow{w.start_feed, w.end_feed}, *c->target->feed})
            .value();
    EXPECT_NEAR(cycle(again, spec)->pieces_per_hour, *spec.target, 1e-6 * *spec.target);
  }
  EXPECT_GT(planned, 200);
}

TEST(RapidMove, CoversItsDistanceExactly) {
  std::mt19937_64 random(8);
  const auto any = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 2000; ++i) {
    const CylinderLimits limits{any(5.0, 500.0), any(5.0, 5000.0), any(100.0, 1e6)};
    const double leave = any(0.0, 1.0) * limits.speed;
    const double distance = any(0.01, 500.0);
    const auto move = rapid_move(distance, leave, limits);
    if (!move) {
      EXPECT_GT(ramp(0.0, leave, limits).distance, distance);
      continue;
    }
    EXPECT_LE(move->peak, limits.speed);
    EXPECT_GE(move->cruise, 0.0);
    const double travelled = ramp(0.0, move->peak, limits).distance + move->cruise * move->peak +
                             ramp(move->peak, leave, limits).distance;
    EXPECT_NEAR(travelled, distance, 1e-13 * distance);
    // never needlessly slow: a move below the speed limit does not cruise
    if (move->peak < limits.speed) {
      EXPECT_LE(move->cruise, 1e-6 * move->duration);
    }
  }
}

}  // namespace
}  // namespace tubecut::cutoff
