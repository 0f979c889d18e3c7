// Metamorphic laws of section 9, determinism, and the permitted effects of a change of the request.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <stop_token>
#include <thread>

#include "core/motion/replay/replay.hpp"
#include "tests/core/motion/jobs.hpp"
#include "tests/core/motion/random_jobs.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::motion::testing {
namespace {

TEST(Laws, SameRequestSameCounts) {
  const Schedule a = planned(table1(20)), b = planned(table1(20));
  for (std::size_t i = 0; i < a.axes.size(); ++i) EXPECT_EQ(a.axes[i].counts, b.axes[i].counts);
}

TEST(Laws, MirrorNegatesTheTurn) {
  ScheduleSpec spec = table1(0);
  const Schedule a = planned(spec);
  for (double& phi : std::get<CutPath>(spec.cut).phi) phi = -phi;
  const Schedule b = planned(spec);
  ASSERT_EQ(a.periods, b.periods);
  EXPECT_EQ(axis(b, "C").total, -360000);
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < axis(a, "C").counts.size(); ++k) {
    sum += axis(a, "C").counts[k] + axis(b, "C").counts[k];
    EXPECT_LE(std::abs(sum), 1) << k;  // exact halves round up on both sides
  }
  for (const char* const name : {"Y", "Z1", "B"})
    EXPECT_EQ(axis(a, name).counts, axis(b, name).counts);
}

TEST(Laws, ReversedContourTakesAsLong) {
  for (const int points : {0, 20}) {
    ScheduleSpec spec = table1(points);
    const Schedule a = planned(spec);
    auto& c = std::get<CutPath>(spec.cut);
    std::ranges::reverse(c.phi);
    std::ranges::reverse(c.z);
    std::ranges::reverse(c.b);
    const Schedule b = planned(spec);
    EXPECT_NEAR(static_cast<double>(a.periods), static_cast<double>(b.periods), 0.002 * a.periods);
    EXPECT_NEAR(a.report.no_jerk, b.report.no_jerk, 1e-6 * a.report.no_jerk);
  }
}

TEST(Laws, LessSpeedNeverSavesTime) {
  double before = 0.0;
  for (const double speed : {25.0, 18.0, 13.0, 9.0, 6.0, 4.0, 2.0}) {
    const double time = planned(table1(0, speed)).report.time;
    EXPECT_GE(time, 0.995 * before) << speed;
    before = time;
  }
}

TEST(Laws, FewerPulsesNeverSaveTime) {
  double before = 0.0;
  for (const std::int64_t most : {1000, 500, 250, 120, 60}) {
    ScheduleSpec spec = table1(0);
    for (Axis& axis : spec.machine.axes) axis.n_max = most;
    const Schedule s = planned(spec);
    EXPECT_GE(s.report.time, 0.995 * before) << most;
    for (const AxisPulses& axis : s.axes) EXPECT_LE(axis.peak, most);
    before = s.report.time;
  }
}

/// "n_max 5 on raw B: 836 s, still exact."
TEST(Laws, FivePulsesAPeriodAreEnough) {
  ScheduleSpec spec = table1(0);
  for (Axis& axis : spec.machine.axes) axis.n_max = 5;
  const Schedule s = planned(spec);
  EXPECT_NEAR(s.report.time, 836.0, 1.0);
  EXPECT_EQ(axis(s, "C").total, 360000);
  for (const AxisPulses& axis : s.axes) EXPECT_LE(axis.peak, 5);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
}

TEST(Laws, TwiceThePulsesTwiceTheTotals) {
  ScheduleSpec spec = table1(20);
  auto& contour = std::get<CutPath>(spec.cut);
  contour.phi.resize(181);
  contour.z.resize(181);
  contour.b.resize(181);
  contour.closed = false;
  const Schedule a = planned(spec);
  for (Axis& axis : spec.machine.axes) {
    axis.pulses_per_turn *= 2;
    axis.pulses_per_unit *= 2;
    *axis.n_max *= 2;
  }
  const Schedule b = planned(spec);
  EXPECT_EQ(a.periods, b.periods);
  for (std::size_t i = 0; i < a.axes.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(b.axes[i].total), 2.0 * static_cast<double>(a.axes[i].total),
                1.0);
  }
}

TEST(Laws, PeriodDoesNotChangeTheTime) {
  ScheduleSpec spec = table1(20);
  const double slow = planned(spec).report.time;
  spec.machine.period = 0.001;
  EXPECT_NEAR(planned(spec).report.time, slow, 0.002 * slow);
}

TEST(Laws, ATableOfOneSpeedIsTheNumber) {
  ScheduleSpec spec = table1(0);
  auto& contour = std::get<CutPath>(spec.cut);
  contour.wall = 5.0;
  const Schedule number = planned(spec);
  spec.motion.speed = SpeedTable{{{1.0, kFeed}, {10.0, kFeed}, {50.0, kFeed}}};
  const Schedule table = planned(spec);
  for (std::size_t i = 0; i < number.axes.size(); ++i) {
    EXPECT_EQ(number.axes[i].counts, table.axes[i].counts);
  }
  EXPECT_EQ(number.report.time, table.report.time);
}

TEST(Laws, CancelledIsCancelled) {
  const auto spec = table1(0);
  const CancelledScope cancelled;
  const auto s = schedule(spec);
  ASSERT_FALSE(s);
  EXPECT_EQ(s.error().code(), ErrorCode::cancelled);
}

/// Whatever a stop leaves half made is not read: the standard library's checks are on in this
/// build.
TEST(Laws, AStopAtAnyMomentIsCancelled) {
  using Clock = std::chrono::steady_clock;
  ScheduleSpec spec = random_job(11);
  const auto begun = Clock::now();
  ASSERT_TRUE(schedule(spec));
  const auto whole = Clock::now() - begun;
  int cancelled = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::stop_source source;
    std::jthread stopper([&] {
      std::this_thread::sleep_for(whole * trial / 200);
      source.request_stop();
    });
    const StopScope scope(source.get_token());
    const auto s = schedule(spec);
    if (s) continue;
    EXPECT_EQ(s.error().code(), ErrorCode::cancelled);
    ++cancelled;
  }
  EXPECT_GT(cancelled, 0);  // the number depends on the load of the machine
}

TEST(Laws, WithoutJerkTheOptimumIsReached) {
  ScheduleSpec spec = table1(0);
  spec.motion.jerk = false;
  const Schedule s = planned(spec);
  EXPECT_LE(s.report.time, s.report.no_jerk + spec.machine.period);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
}

TEST(Laws, AxesWithoutJerkLimitsAreUnchanged) {
  ScheduleSpec spec = table1(0);
  for (Axis& axis : spec.machine.axes) axis.j_max.reset();
  const Schedule s = planned(spec);
  EXPECT_EQ(s.report.filter, 0.0);
  spec.machine.axes[4].j_max = 6000.0;
  const Schedule b_only = planned(spec);
  EXPECT_GT(b_only.report.filter, 0.0);
  for (const Check& check : verify(spec, b_only)) EXPECT_TRUE(check.passed()) << check.name;
}

}  // namespace
}  // namespace tubecut::motion::testing
