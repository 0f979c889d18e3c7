// Machines: refusals, the built-in ones, columns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/replay/replay.hpp"
#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

TEST(Refused, MachineWithoutALimit) {
  ScheduleSpec spec = table1(0);
  spec.machine.axes[1].a_max = 0.0;
  const Issue issue = refusal(spec);
  EXPECT_EQ(issue.code, ErrorCode::zero_limit);
  EXPECT_EQ(issue.member, "machine/axes/1/a_max");
  spec = table1(0);
  spec.machine.axes.erase(spec.machine.axes.begin());
  EXPECT_EQ(refusal(spec).code, ErrorCode::wrong_count);
}

TEST(Refused, StandoffBeyondTheCrawlersLimit) {
  ScheduleSpec spec = table1(20);
  spec.machine = catalogue()[1].machine;
  auto& crawler = std::get<Crawler>(spec.machine.kinematics);
  crawler.swing_center = SwingCenter::pivot;
  crawler.pivot_length = 150.0;
  crawler.standoff_max = 3.0;
  EXPECT_EQ(refusal(spec).code, ErrorCode::standoff_too_large);
}

TEST(Machines, BuiltInOnesAreSound) {
  const auto all = catalogue();
  ASSERT_EQ(all.size(), 5U);
  for (const CatalogueEntry& entry : all) {
    EXPECT_TRUE(check(entry.machine)) << entry.machine.name;
    EXPECT_EQ(type_name(entry.machine), entry.machine.name);
    std::size_t numbers = 3;
    for (const Axis& axis : entry.machine.axes) {
      numbers += 7 + (axis.soft_min ? 1 : 0) + (axis.soft_max ? 1 : 0);
    }
    EXPECT_GE(entry.values.size(), numbers);
    for (const Provenance& value : entry.values) EXPECT_NE(value.assumption, !value.source.empty());
  }
}

TEST(Machines, CrawlerCutsAndReportsItsResidual) {
  ScheduleSpec spec = table1(20);
  spec.machine = catalogue()[1].machine;
  spec.machine.kinematics =
      Crawler{.wheel_offset = 60.0, .swing_center = SwingCenter::pivot, .pivot_length = 20.0};
  for (double& b : contour_of(spec).b) b *= 0.5;
  const Schedule s = planned(spec);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
  const double turn = kTwoPi * (35.0 + 60.0) * 1000.0;
  EXPECT_NEAR(s.report.closing_residual, turn - std::floor(turn), 1e-6);
  EXPECT_EQ(axis(s, "S").total, static_cast<std::int64_t>(std::floor(turn + 0.5)));
  EXPECT_EQ(axis(s, "E").total, 0);
  EXPECT_GT(s.report.standoff_growth, 0.0);
  EXPECT_TRUE(std::ranges::any_of(
      s.warnings, [](const Warning& w) { return w.code == WarningCode::standoff; }));
}

AxisColumns mill_path() {
  AxisColumns cut;
  cut.tip_radius = 80.0;
  cut.closed = true;
  cut.columns.assign(4, {});
  for (int i = 0; i <= 180; ++i) {
    const double w = kTwoPi * i / 180;
    cut.columns[0].push_back(2.0 * i);
    cut.columns[1].push_back(20.0 + 3.0 * std::cos(2 * w));
    cut.columns[2].push_back(10.0 * std::cos(2 * w));
    cut.columns[3].push_back(30.0 + 10.0 * std::sin(w));
  }
  return cut;
}

TEST(Machines, MillFollowsItsColumns) {
  ScheduleSpec spec;
  spec.cut = mill_path();
  spec.machine = catalogue()[2].machine;
  spec.motion.speed = 5.0;
  const Schedule s = planned(spec);
  EXPECT_EQ(axis(s, "C").total, 360000);
  EXPECT_EQ(axis(s, "X").total, 0);
  const auto checks = verify(spec, s);
  EXPECT_GE(checks.size(), 13U);
  for (const Check& check : checks) EXPECT_TRUE(check.passed()) << check.name << " " << check.value;
}

TEST(Machines, PlainAxesFollowTheirColumns) {
  ScheduleSpec spec;
  AxisColumns cut = mill_path();
  cut.tip_radius = 0.0;
  for (int i = 0; i <= 180; ++i) cut.length.push_back(2.8 * i);
  spec.cut = cut;
  spec.machine = catalogue()[2].machine;
  spec.machine.kinematics = Generic{};
  spec.motion.speed = 5.0;
  const Schedule s = planned(spec);
  EXPECT_GE(s.report.time, 180 * 2.8 / 5.0);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
  spec.motion.lead = Lead{};
  EXPECT_EQ(refusal(spec).code, ErrorCode::unsupported_combination);
}

}  // namespace
}  // namespace tubecut::motion::testing
