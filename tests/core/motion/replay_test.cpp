// Damaged schedules are refused, each by the invariant that section 9 of the spec names; and
// metamorphic laws.
#include "core/motion/replay/replay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

ReplaySpec as_sent(const ScheduleSpec& spec, const Schedule& s) {
  ReplaySpec out{spec, s.period, {}, {}};
  for (const AxisPulses& axis : s.axes) {
    out.counts.emplace_back(axis.counts.begin(), axis.counts.end());
    out.start.push_back(axis.start);
  }
  return out;
}

std::set<std::string> failed(const std::vector<Check>& checks) {
  std::set<std::string> out;
  for (const Check& check : checks) {
    if (!check.passed()) out.insert(check.name);
  }
  return out;
}

std::set<std::string> failed(const ReplaySpec& spec) {
  const auto result = replay(spec);
  EXPECT_TRUE(result);
  return result ? failed(result->invariants) : std::set<std::string>{};
}

constexpr std::size_t kC = 0, kY = 1, kZ1 = 2, kB = 4;

class Damaged : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    const ScheduleSpec spec = table1(GetParam());
    good = as_sent(spec, planned(spec));
    ASSERT_TRUE(failed(good).empty());
  }
  std::vector<double>& column(std::size_t axis) { return good.counts[axis]; }
  void expect(const std::string& invariant) const {
    const auto names = failed(good);
    EXPECT_TRUE(names.contains(invariant)) << invariant << " held";
  }
  std::size_t busiest(std::size_t axis) {
    const auto at = std::ranges::max_element(
        column(axis), [](double a, double b) { return std::abs(a) < std::abs(b); });
    return static_cast<std::size_t>(at - column(axis).begin());
  }
  void late(std::size_t axis) {
    auto& c = column(axis);
    std::rotate(c.begin(), c.end() - 25, c.end());
    std::fill(c.begin(), c.begin() + 25, 0.0);
  }
  ReplaySpec good;
};

TEST_P(Damaged, OnePulseMore) {
  column(kB)[1000] += 1;
  expect("I2");
  expect("I3");
}
TEST_P(Damaged, StartNextToTheFirstPoint) {
  const std::vector<double> right = good.start;
  for (const auto& [axis, off] : {std::pair{kY, 0.05}, std::pair{kC, 0.1}, std::pair{kB, -0.001}}) {
    good.start = right;
    good.start[axis] += off;
    expect("I16");
  }
  good.start = right;
  good.start[kC] += 720.0;  // whole turns
  EXPECT_FALSE(failed(good).contains("I16"));
}
TEST_P(Damaged, LostPeriod) {
  const std::size_t k = busiest(kB);
  for (auto& c : good.counts) {
    if (!c.empty()) c.erase(c.begin() + static_cast<std::ptrdiff_t>(k));
  }
  expect("I2");
  expect("I3");
}
TEST_P(Damaged, Kick) {
  column(kB)[2000] += 40;
  column(kB)[2001] -= 40;
  expect("I6");
  expect("I7");
}
TEST_P(Damaged, ThreePeriodsInOne) {
  const std::size_t k = busiest(kY);
  for (auto& c : good.counts) {
    if (c.empty()) continue;
    c[k] += c[k - 1] + c[k + 1];
    c[k - 1] = c[k + 1] = 0.0;
  }
  expect("I4");
  expect("I5");
}
TEST_P(Damaged, ThreePeriodsOfTheTurnInOne) {
  auto& c = column(kC);
  const std::size_t k = busiest(kC);
  c[k] += c[k - 1] + c[k + 1];
  c[k - 1] = c[k + 1] = 0.0;
  expect("I14");
}
TEST_P(Damaged, Clipped) {
  for (auto& c : good.counts) {
    double peak = 0.0;
    for (const double n : c) peak = std::max(peak, std::abs(n));
    for (double& n : c) n = std::trunc(std::clamp(n, -0.9 * peak, 0.9 * peak));
  }
  expect("I2");
}
TEST_P(Damaged, Floats) {
  column(kY)[500] += 0.25;
  column(kY)[501] -= 0.25;
  expect("I1");
}
TEST_P(Damaged, AxisReversed) {
  for (double& n : column(kC)) n = -n;
  expect("I2");
  for (double& n : column(kC)) n = -n;
  for (double& n : column(kY)) n = -n;
  expect("I10");
}
TEST_P(Damaged, AxisLate) {
  late(kC);
  expect("I10");
}
TEST_P(Damaged, HeightLate) {
  late(kZ1);
  expect("I13");
}
TEST_P(Damaged, CarriageLate) {
  late(kY);
  expect("I10");
  expect("I14");
}
TEST_P(Damaged, AxisDropped) {
  std::fill(column(kB).begin(), column(kB).end(), 0.0);
  expect("I10");
  expect("I12");
}
TEST_P(Damaged, TravelBeyondItsLimits) {
  good.start[kB] += 90.0;
  expect("I8");
}
TEST_P(Damaged, ReversalAtSpeed) {
  const std::size_t k = busiest(kY);
  column(kY)[k] *= -1;
  expect("I9");
}
TEST_P(Damaged, StretchLeftOut) {
  for (auto& c : good.counts) {
    if (c.empty()) continue;
    const auto quarter = static_cast<std::ptrdiff_t>(c.size() / 4);
    c.erase(c.begin() + quarter, c.begin() + 2 * quarter);
  }
  expect("I11");
}
TEST_P(Damaged, DoubleSpeed) {
  for (auto& c : good.counts) {
    std::vector<double> pairs;
    for (std::size_t k = 0; k + 1 < c.size(); k += 2) pairs.push_back(c[k] + c[k + 1]);
    if (c.size() % 2 == 1) pairs.push_back(c.back());
    c = pairs;
  }
  expect("I15");
  expect("I14");
}

INSTANTIATE_TEST_SUITE_P(Table1, Damaged, ::testing::Values(0, 20));

TEST(Damage, LeadThroughThePart) {
  ScheduleSpec spec = table1(20);
  spec.motion.lead = Lead{};
  Schedule s = planned(spec);
  ASSERT_TRUE(failed(verify(spec, s)).empty());
  ASSERT_EQ(s.events[2].what, EventKind::cut_start);
  // The pierce 10 mm up in the part, taken back evenly until the cut.
  AxisPulses& carriage = s.axes[kY];
  const auto periods = s.events[2].period;
  for (std::int64_t k = 0; k < periods; ++k) {
    const std::int64_t share = 10000 * (k + 1) / periods - 10000 * k / periods;
    carriage.counts[static_cast<std::size_t>(k)] -= static_cast<std::int32_t>(share);
  }
  carriage.start += 10.0;
  EXPECT_TRUE(failed(verify(spec, s)).contains("lead_clears_part"));
}

TEST(Damage, AnswerThatDoesNotFitItsRequest) {
  const ScheduleSpec spec = table1(20);
  Schedule s = planned(spec);
  s.axes[kB].counts.pop_back();
  EXPECT_TRUE(failed(verify(spec, s)).contains("replayable"));
}

TEST(Replay, GivesThePathBack) {
  const ScheduleSpec spec = table1(20);
  const auto result = replay(as_sent(spec, planned(spec)));
  ASSERT_TRUE(result);
  const auto& contour = std::get<CutPath>(spec.cut);
  ASSERT_FALSE(result->phi.empty());
  EXPECT_EQ(result->phi.size(), result->z.size());
  EXPECT_NEAR(result->phi.back() - result->phi.front(), kTwoPi, 1e-12);
  EXPECT_NEAR(result->z.front(), contour.z.front(), 1e-9);
  EXPECT_NEAR(result->b.front(), contour.b.front(), 1e-9);
  EXPECT_LT(result->deviation, 0.1);
}

TEST(Replay, RefusesWhatIsNotASchedule) {
  const ScheduleSpec spec = table1(20);
  ReplaySpec sent = as_sent(spec, planned(spec));
  ReplaySpec bad = sent;
  bad.counts.pop_back();
  EXPECT_EQ(replay(bad).error().code(), ErrorCode::wrong_count);
  bad = sent;
  bad.counts[kY].pop_back();
  EXPECT_EQ(replay(bad).error().code(), ErrorCode::wrong_count);
  bad = sent;
  bad.counts[kY][5] = std::nan("");
  EXPECT_EQ(replay(bad).error().code(), ErrorCode::bad_number);
  bad = sent;
  bad.period = 0.0;
  EXPECT_EQ(replay(bad).error().code(), ErrorCode::bad_number);
}

/// A wrong sign of the machine's B is seen, not cut.
TEST(Replay, SeesAWrongSign) {
  const ScheduleSpec spec = table1(20);
  ReplaySpec sent = as_sent(spec, planned(spec));
  sent.job.machine.b_positive = BPositive::outer_edge_into_part;
  EXPECT_TRUE(failed(sent).contains("I10"));
}

}  // namespace
}  // namespace tubecut::motion::testing
