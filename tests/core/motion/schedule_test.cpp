// Refusals of a whole schedule, and the content of its report.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/replay/replay.hpp"
#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

TEST(Refused, SoftLimitNamesAxisBoundValueAndPhi) {
  ScheduleSpec spec = table1(0);
  spec.machine.axes[4].soft_max = 60.0;
  const Issue issue = refusal(spec);
  EXPECT_EQ(issue.code, ErrorCode::soft_limit);
  EXPECT_EQ(issue.member, "machine/axes/4/soft_max");
  EXPECT_EQ(std::get<double>(issue.limit), 60.0);
  EXPECT_NEAR(std::get<double>(issue.got), 74.1, 0.5);
  EXPECT_NE(issue.hint.find("axis B at phi"), std::string::npos) << issue.hint;
}

/// Both before any path exists (a slow cut) and before any sample (a slow axis).
TEST(Refused, TooManyPeriodsBeforeMemoryIsTaken) {
  ScheduleSpec spec = table1(0, 1e-6);
  EXPECT_EQ(refusal(spec).code, ErrorCode::too_many_periods);
  spec = table1(0);
  spec.machine.axes[4].v_max = 1e-6;
  EXPECT_EQ(refusal(spec).code, ErrorCode::too_many_periods);
  spec = table1(0);
  spec.max_periods = 8000;
  const Issue issue = refusal(spec);
  EXPECT_EQ(issue.code, ErrorCode::too_many_periods);
  EXPECT_EQ(std::get<double>(issue.limit), 8000.0);
}

TEST(Reports, LocateSlowSegments) {
  const Schedule raw = planned(table1(0));
  ASSERT_EQ(raw.report.slow.size(), 5U);  // the five junctions of Table 1
  for (const SlowZone& zone : raw.report.slow) {
    EXPECT_LT(zone.least_speed, 0.5 * kFeed);
    EXPECT_FALSE(zone.axis.empty());
  }
  EXPECT_NEAR(raw.report.slow[2].phi_from * kDegPerRad, 216.5, 1.0);
  EXPECT_EQ(std::ranges::count(raw.warnings, WarningCode::slow_zone, &Warning::code), 5);
  EXPECT_TRUE(planned(table1(20)).report.slow.empty());
}

TEST(Reports, CoarseContour) {
  ScheduleSpec spec;
  CutPath c;
  c.outer_radius = 35.0;
  for (int i = 0; i <= 8; ++i) {
    c.phi.push_back(kTwoPi * i / 8);
    c.z.push_back(25.0 * std::cos(kTwoPi * i / 8));
    c.b.push_back(0.0);
  }
  c.z.back() = c.z.front();
  spec.cut = c;
  spec.machine = source_machine();
  const Schedule s = planned(spec);
  EXPECT_EQ(std::ranges::count(s.warnings, WarningCode::contour_too_coarse, &Warning::code), 1);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
}

}  // namespace
}  // namespace tubecut::motion::testing
