// The hand cases of the golden file and sections 10.1 and 10.2 of the spec, from an independent
// program.
#include "tests/support/golden.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "core/motion/path/course.hpp"
#include "core/motion/replay/reconstruction.hpp"
#include "core/motion/schedule/schedule.hpp"
#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

using tubecut::testing::number;
using tubecut::testing::numbers;

TEST(Golden, Trapezoid) {
  const api::Json& golden = golden_case("trapezoid");
  const Axis z{.name = "Z", .pulses_per_unit = 1000, .v_max = 10, .a_max = 100};
  ScheduleSpec spec = straight_line(z, 100, 10, 0.01);
  spec.motion.jerk = false;
  const Schedule s = planned(spec);
  EXPECT_EQ(s.periods, number(golden, "expect/M"));
  const auto& counts = axis(s, "Z").counts;
  ASSERT_EQ(counts.size(), 1010U);
  EXPECT_EQ(axis(s, "Z").total, number(golden, "expect/total"));
  EXPECT_EQ(axis(s, "Z").peak, number(golden, "expect/peak"));
  const auto first = numbers(golden, "expect/first12"), last = numbers(golden, "expect/last3");
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_EQ(counts[k], first[k]) << k;
  for (std::size_t k = 0; k < last.size(); ++k) EXPECT_EQ(counts[1007 + k], last[k]) << k;
}

TEST(Golden, FilteredRamp) {
  const api::Json& golden = golden_case("fir_ramp");
  const Axis z{.name = "Z", .pulses_per_unit = 1200, .v_max = 10, .a_max = 100, .j_max = 2000};
  ScheduleSpec spec = straight_line(z, 100, 10, 0.01);
  spec.motion.expert.filter = 0.1;
  const Schedule s = planned(spec);
  EXPECT_EQ(s.periods, number(golden, "expect/M"));
  EXPECT_EQ(axis(s, "Z").total, number(golden, "expect/total"));
  const auto expected = numbers(golden, "expect/N_first11");
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(sum, expected[k]) << k;
    sum += axis(s, "Z").counts[k];
  }
}

TEST(Golden, Rounding) {
  const api::Json& golden = golden_case("rounding");
  const auto expected = numbers(golden, "expect/n");
  ASSERT_FALSE(expected.empty());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const auto before = static_cast<double>(k);
    EXPECT_EQ(rounded(0.4 * (before + 1.0)) - rounded(0.4 * before), expected[k]) << k;
  }
}

TEST(Golden, RoundingOfHalvesGoesUpOnBothSigns) {
  const api::Json& golden = golden_case("rounding_halves");
  const auto p = numbers(golden, "given/p"), cumulative = numbers(golden, "expect/N");
  for (std::size_t k = 0; k < p.size(); ++k) EXPECT_EQ(rounded(p[k]), cumulative[k]);
  const auto expected = numbers(golden, "expect/n");
  ASSERT_EQ(expected.size() + 1, p.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_EQ(rounded(p[k + 1]) - rounded(p[k]), expected[k]) << k;
}

TEST(Golden, TwoPasses) {
  const api::Json& golden = golden_case("two_pass");
  const auto rows = [](double alpha, double beta, double c) {
    Rows out;
    for (int i = 0; i < 4; ++i) {
      out.add({alpha, beta, c});
      out.close_interval();
    }
    return out;
  };
  EXPECT_EQ(largest_profile({0, 1e300, 1e300, 1e300, 0}, 1.0, rows(1, 0, 2)),
            numbers(golden, "expect/a"));
  EXPECT_EQ(largest_profile({0, 1e300, 1e300, 1e300, 0}, 1.0, rows(1, 0.5, 2)),
            numbers(golden, "expect/b"));
  EXPECT_EQ(largest_profile({9, 9, 1, 9, 9}, 1.0, rows(1, 0, 2)), numbers(golden, "expect/c"));
}

std::vector<double> axes_at(const ScheduleSpec& spec, double phi, double z, double b) {
  const auto functions = axis_functions(spec);
  std::vector<double> out;
  for (const AxisFunction& f : *functions) out.push_back(f.at(Coordinates{phi, z, b}));
  return out;
}

void expect_axes(const std::vector<double>& got, const std::vector<double>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t a = 0; a < got.size(); ++a) EXPECT_NEAR(got[a], expected[a], 1e-8) << a;
}

TEST(Golden, TorchCentrePoint) {
  const api::Json& golden = golden_case("tcp");
  ScheduleSpec spec;
  spec.machine = source_machine();
  CutPath contour;
  contour.outer_radius = 50.0;
  spec.cut = contour;
  expect_axes(axes_at(spec, kPi / 2, 10, kPi / 6), numbers(golden, "expect/a"));
  contour.wall = 5.0;
  contour.surface = Surface::inner;
  spec.cut = contour;
  expect_axes(axes_at(spec, 0, 10, kPi / 4), numbers(golden, "expect/b"));
  contour = {};
  contour.outer_radius = 100.0;
  spec.cut = contour;
  spec.machine = catalogue()[1].machine;
  spec.machine.b_positive = BPositive::outer_edge_to_waste;
  spec.machine.kinematics = Crawler{.swing_center = SwingCenter::pivot, .pivot_length = 20.0};
  expect_axes(axes_at(spec, kPi, 5, kPi / 4), numbers(golden, "expect/c"));
}

TEST(Golden, OverflowIsAVelocityCap) {
  const api::Json& golden = golden_case("overflow_cap");
  const Axis b{.name = "B",
               .unit = AxisUnit::deg,
               .pulses_per_unit = 1000,
               .v_max = 45,
               .a_max = 300,
               .n_max = 100};
  EXPECT_DOUBLE_EQ(velocity_limit(b, 0.004), number(golden, "expect/v"));
}

TEST(Golden, KinkThroughTwoMeans) {
  const api::Json& golden = golden_case("kink");
  std::vector<double> x;
  for (int j = -8; j <= 8; ++j) x.push_back(std::abs(j));
  const auto p = box2(x, 1);
  const auto expected = numbers(golden, "expect/samples");
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(p[6 + j], expected[j], 1e-11) << j;
  EXPECT_NEAR((p[7] + 4 * p[8] + p[9]) / 6, number(golden, "expect/spline_at_kink"), 1e-15);
}

TEST(Golden, Ring) {
  const api::Json& golden = golden_case("ring");
  ScheduleSpec spec;
  CutPath contour;
  contour.outer_radius = number(golden, "given/r");
  for (int i = 0; i <= 72; ++i) {
    contour.phi.push_back(kTwoPi * i / 72);
    contour.z.push_back(0.0);
    contour.b.push_back(30 * kRadPerDeg);
  }
  spec.cut = contour;
  spec.machine = source_machine();
  spec.motion.speed = number(golden, "given/F");
  spec.motion.jerk = false;
  const Schedule s = planned(spec);
  EXPECT_EQ(s.periods, number(golden, "expect/M"));
  const auto totals = numbers(golden, "expect/totals"), peaks = numbers(golden, "expect/peak");
  for (std::size_t a = 0; a < 5; ++a) {
    EXPECT_EQ(s.axes[a].total, totals[a]) << a;
    EXPECT_EQ(s.axes[a].peak, peaks[a]) << a;
  }
}

TEST(Golden, JumpOfTheSourceWrapsAnInt16) {
  const api::Json& golden = golden_case("source_jump");
  const ScheduleSpec spec = table1(0);
  const auto& b = std::get<CutPath>(spec.cut).b;
  const auto i = static_cast<std::size_t>(number(golden, "expect/index"));
  const double jump = (b[i + 1] - b[i]) * kDegPerRad;
  EXPECT_NEAR(jump, number(golden, "expect/dB_deg"), 1e-6);
  const auto pulses = rounded(std::abs(jump) * number(golden, "given/pulses_per_deg"));
  EXPECT_EQ(pulses, number(golden, "expect/pulses"));
  EXPECT_EQ(static_cast<std::int16_t>(pulses), number(golden, "expect/wrapped"));
}

class Table1Case : public ::testing::TestWithParam<std::pair<const char*, int>> {};

TEST_P(Table1Case, AsTheReference) {
  const auto [name, points] = GetParam();
  const api::Json& golden = golden_case(name);
  const Schedule s = planned(table1(points));
  const double periods = number(golden, "expect/M");
  EXPECT_NEAR(static_cast<double>(s.periods), periods, 0.002 * periods);
  const auto totals = numbers(golden, "expect/totals"), peaks = numbers(golden, "expect/peak");
  for (std::size_t a = 0; a < 5; ++a) {
    EXPECT_EQ(s.axes[a].total, totals[a]) << a;
    EXPECT_NEAR(static_cast<double>(s.axes[a].peak), peaks[a], 3) << a;
    EXPECT_EQ(s.axes[a].closure, 0);
  }
  EXPECT_NEAR(s.report.least_tip, number(golden, "expect/min_tip_mm_s"), 0.01);
  EXPECT_EQ(s.report.stretch, 1.0);
}
INSTANTIATE_TEST_SUITE_P(Golden, Table1Case,
                         ::testing::Values(std::pair{"table1_raw", 0},
                                           std::pair{"table1_smoothed", 20}));

/// One column of the tables of section 10.1 and 10.2.
struct Published {
  int points;
  std::array<std::int64_t, 3> naive_peak, naive_over, peak;  // B, Y, Z1
  double whole_s, whole_mm_min, segments_s, stops_s;
  std::int64_t segments, largest_b;
  double no_jerk_s, proven_s, time_s, least_mm_min, slow_s;
};

void PrintTo(const Published& p, std::ostream* out) { *out << p.points << " transition points"; }

class Claim : public ::testing::TestWithParam<Published> {};

TEST_P(Claim, NaivePulses) {
  const Published& p = GetParam();
  const auto job = prepare_cut(table1(p.points));
  ASSERT_TRUE(job);
  const auto naive = comparison(*job).naive;
  const std::array<std::size_t, 3> axes{4, 1, 2};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& axis = naive.axes[axes[i]];
    EXPECT_EQ(axis.peak, p.naive_peak[i]) << axis.name;
    EXPECT_EQ(axis.periods_over, p.naive_over[i]) << axis.name;
    EXPECT_EQ(axis.pulses.size() + 1, naive.time.size());
  }
  // Every segment in its own time: the whole cut in length over speed.
  EXPECT_NEAR(naive.time.back(), 29.03, 0.005);
  // By 000, section 2: 16 bits hold 32 767 pulses, and read a step of 41 791 as one of 23 745 the
  // other way.
  EXPECT_EQ(std::abs(naive.axes[4].largest_step), p.largest_b);
  const auto read = naive.axes[4].step_in_16_bits();
  if (p.largest_b == 41791)
    EXPECT_EQ(read, naive.axes[4].largest_step < 0 ? 23745 : -23745);
  else
    EXPECT_EQ(read, naive.axes[4].largest_step);
}

TEST_P(Claim, Times) {
  const Published& p = GetParam();
  ScheduleSpec spec = table1(p.points);
  spec.motion.compare = true;
  const Schedule s = planned(spec);
  ASSERT_TRUE(s.comparison);
  EXPECT_NEAR(s.report.ideal, 29.03, 0.005);
  EXPECT_NEAR(s.report.length, 290.28, 0.005);
  EXPECT_NEAR(s.comparison->whole_cut_time, p.whole_s, 0.01 * p.whole_s);
  EXPECT_NEAR(60 * s.comparison->whole_cut_speed, p.whole_mm_min, 0.01 * p.whole_mm_min);
  EXPECT_NEAR(s.comparison->segments_time, p.segments_s, 0.01 * p.segments_s);
  EXPECT_NEAR(s.comparison->segments_stop_time, p.stops_s, 0.01 * p.stops_s);
  EXPECT_EQ(s.comparison->slow_segments, p.segments);
  // The reference adds magnitudes, which forbids cancellation, for at most 0.7 % of the time.
  EXPECT_LE(s.report.no_jerk, 1.001 * p.no_jerk_s);
  EXPECT_GE(s.report.no_jerk, 0.992 * p.no_jerk_s);
  EXPECT_NEAR(s.report.proven, p.proven_s, 0.001 * p.proven_s);
  EXPECT_NEAR(s.report.time, p.time_s, 0.001 * p.time_s);
  EXPECT_LE(s.report.time, 1.02 * p.no_jerk_s);
  EXPECT_NEAR(60 * s.report.least_tip, p.least_mm_min, 0.5);
  EXPECT_NEAR(s.report.slow_time, p.slow_s, 0.01);
  const std::array<std::size_t, 3> axes{4, 1, 2};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(static_cast<double>(s.axes[axes[i]].peak), static_cast<double>(p.peak[i]), 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, Claim,
                         ::testing::Values(Published{0,
                                                     {2438, 5007, 3704},
                                                     {52, 89, 89},
                                                     {180, 434, 395},
                                                     393.2,
                                                     44.3,
                                                     31.06,
                                                     31.90,
                                                     5,
                                                     41791,
                                                     31.65,
                                                     32.88,
                                                     32.21,
                                                     30,
                                                     3.32},
                                           Published{10,
                                                     {450, 1013, 728},
                                                     {0, 65, 0},
                                                     {180, 440, 400},
                                                     72.5,
                                                     240,
                                                     29.80,
                                                     33.15,
                                                     23,
                                                     7140,
                                                     29.88,
                                                     30.16,
                                                     30.05,
                                                     238,
                                                     0.67},
                                           Published{20,
                                                     {247, 555, 406},
                                                     {0, 0, 0},
                                                     {180, 426, 379},
                                                     39.8,
                                                     438,
                                                     29.17,
                                                     30.43,
                                                     9,
                                                     3791,
                                                     29.27,
                                                     29.58,
                                                     29.46,
                                                     439,
                                                     0.0}));

/// "this schedule at 3000 mm/min": recommended, no jerk, proven.
TEST(Golden, FastCut) {
  for (const auto& [points, time, no_jerk, proven] :
       {std::tuple{0, 14.29, 12.28, 17.45}, std::tuple{20, 12.58, 11.43, 14.10}}) {
    const Schedule s = planned(table1(points, 50.0));
    EXPECT_NEAR(s.report.time, time, 0.01 * time);
    EXPECT_LE(s.report.no_jerk, 1.001 * no_jerk);  // magnitudes cost the reference 2.6 to 4.2 %
    EXPECT_GE(s.report.no_jerk, 0.955 * no_jerk);
    EXPECT_NEAR(s.report.proven, proven, 0.002 * proven);
  }
}

/// "in other periods": naive peak of B at 1 and 10 ms.
TEST(Golden, NaivePeaksInOtherPeriods) {
  for (const auto& [points, at_1ms, at_10ms] :
       {std::tuple{0, 610, 6095}, std::tuple{10, 112, 1124}, std::tuple{20, 62, 616}}) {
    ScheduleSpec spec = table1(points);
    spec.machine.period = 0.001;
    EXPECT_EQ(comparison(*prepare_cut(spec)).naive.axes[4].peak, at_1ms);
    spec.machine.period = 0.010;
    EXPECT_EQ(comparison(*prepare_cut(spec)).naive.axes[4].peak, at_10ms);
  }
}

/// With sigma = -1 the same columns give the other peaks of Y; times do not change.
TEST(Golden, OtherSignOfSigma) {
  for (const auto& [points, peak] :
       {std::tuple{0, 5043}, std::tuple{10, 993}, std::tuple{20, 549}}) {
    ScheduleSpec spec = table1(points);
    spec.machine.b_positive = BPositive::outer_edge_into_part;
    EXPECT_EQ(comparison(*prepare_cut(spec)).naive.axes[1].peak, peak);
  }
}

}  // namespace
}  // namespace tubecut::motion::testing
