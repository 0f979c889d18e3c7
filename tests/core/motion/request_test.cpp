// The contract of the input, start point, direction, sector, speed tables and machines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/motion/course.hpp"
#include "core/motion/replay.hpp"
#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

Contour& contour_of(ScheduleSpec& spec) { return std::get<Contour>(spec.cut); }

Issue refusal(const ScheduleSpec& spec) {
  const auto s = schedule(spec);
  EXPECT_FALSE(s);
  return s ? Issue{} : s.error().issues.front();
}

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

TEST(Refused, ContourThatDoesNotClose) {
  ScheduleSpec spec = table1(0);
  contour_of(spec).z.back() += 1e-3;
  EXPECT_EQ(refusal(spec).code, ErrorCode::not_closed);
  spec = table1(0);
  contour_of(spec).b.back() += 1e-3;
  EXPECT_EQ(refusal(spec).code, ErrorCode::not_closed);
  spec = table1(0);
  for (auto* const column : {&contour_of(spec).phi, &contour_of(spec).z, &contour_of(spec).b}) {
    column->resize(300);
  }
  EXPECT_EQ(refusal(spec).code, ErrorCode::not_closed);
}

TEST(Refused, DuplicatePoint) {
  ScheduleSpec spec = table1(0);
  Contour& c = contour_of(spec);
  c.phi[7] = c.phi[6];
  c.z[7] = c.z[6];
  c.b[7] = c.b[6];
  const Issue issue = refusal(spec);
  EXPECT_EQ(issue.code, ErrorCode::duplicate_point);
  EXPECT_EQ(issue.member, "contour/phi/7");
}

// Straight back over the way it came, with or without a swing in place there, and across the join.
TEST(Refused, AContourThatTurnsBack) {
  const auto ring = [](std::vector<double> deg, std::vector<double> z, std::vector<double> b,
                       bool closed) {
    ScheduleSpec spec = table1(0);
    Contour& c = contour_of(spec);
    for (double& one : deg) one *= kRadPerDeg;
    for (double& one : b) one *= kRadPerDeg;
    c.phi = std::move(deg);
    c.z = std::move(z);
    c.b = std::move(b);
    c.closed = closed;
    return spec;
  };
  Issue issue =
      refusal(ring({0, 10, 20, 12, 30, 40}, {0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, false));
  EXPECT_EQ(issue.code, ErrorCode::turns_back);
  EXPECT_EQ(issue.member, "contour/phi/2");
  EXPECT_EQ(
      refusal(ring({0, 10, 20, 20, 12, 2}, {0, 1, 2, 2, 1.2, 0.2}, {0, 0, 0, 9, 0, 0}, false)).code,
      ErrorCode::turns_back);
  // A wedge of a degree is no way back.
  const auto wedge =
      schedule(ring({0, 10, 20, 10, 0}, {0, 0, 0, 0.3, 0.6}, {0, 0, 0, 0, 0}, false));
  EXPECT_TRUE(wedge || wedge.error().code() != ErrorCode::turns_back);
}

TEST(Refused, BadNumbersAndCounts) {
  ScheduleSpec spec = table1(0);
  contour_of(spec).z[3] = std::nan("");
  EXPECT_EQ(refusal(spec).code, ErrorCode::bad_number);
  spec = table1(0);
  contour_of(spec).b[3] = 86 * kRadPerDeg;
  EXPECT_EQ(refusal(spec).code, ErrorCode::angle_out_of_range);
  spec = table1(0);
  contour_of(spec).z.pop_back();
  EXPECT_EQ(refusal(spec).code, ErrorCode::wrong_count);
  spec = table1(0);
  spec.motion.speed = 0.0;
  EXPECT_EQ(refusal(spec).code, ErrorCode::zero_limit);
  spec = table1(0);
  spec.motion.eps_tip = 1e-9;
  EXPECT_EQ(refusal(spec).code, ErrorCode::out_of_range);
}

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

TEST(Refused, SpeedTableThatDoesNotCoverTheBeam) {
  ScheduleSpec spec = table1(0);
  contour_of(spec).wall = 5.0;
  spec.motion.speed = SpeedTable{{{4.0, 20.0}, {10.0, 10.0}}};
  const Issue issue = refusal(spec);
  EXPECT_EQ(issue.code, ErrorCode::speed_table_range);
  EXPECT_GT(std::get<double>(issue.got), 10.0);
  EXPECT_NE(issue.hint.find("phi"), std::string::npos);
}

TEST(Refused, StandoffBeyondTheCrawlersLimit) {
  ScheduleSpec spec = table1(20);
  spec.machine = catalogue()[1].machine;
  EXPECT_EQ(refusal(spec).code, ErrorCode::standoff_too_large);
}

TEST(Contours, OneTurnMayComeOpen) {
  ScheduleSpec spec = table1(20);
  const Schedule closed = planned(spec);
  for (auto* const column : {&contour_of(spec).phi, &contour_of(spec).z, &contour_of(spec).b}) {
    column->pop_back();
  }
  const Schedule open = planned(spec);
  for (std::size_t a = 0; a < closed.axes.size(); ++a) {
    EXPECT_EQ(closed.axes[a].counts, open.axes[a].counts);
  }
}

/// Torch path rebuilt from the counts.
Replay path_of(const ScheduleSpec& spec) {
  const Schedule s = planned(spec);
  ReplaySpec sent{spec, s.period, {}, {}};
  for (const AxisPulses& axis : s.axes) {
    sent.counts.emplace_back(axis.counts.begin(), axis.counts.end());
    sent.start.push_back(axis.start);
  }
  auto result = replay(sent);
  EXPECT_TRUE(result);
  for (const Check& check : result->invariants)
    EXPECT_TRUE(check.passed()) << check.name << check.value;
  return std::move(*result);
}

/// Largest distance of the points of `a` to the path of `b`, in (radius phi, z); phi modulo turns.
double farthest(const Replay& a, const Replay& b, double radius) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.phi.size(); i += 7) {
    double best = 1e300;
    for (std::size_t j = 0; j + 1 < b.phi.size(); ++j) {
      const double turn = kTwoPi * std::round((a.phi[i] - b.phi[j]) / kTwoPi);
      const double s = radius * (a.phi[i] - turn - b.phi[j]), z = a.z[i] - b.z[j];
      const double ds = radius * (b.phi[j + 1] - b.phi[j]), dz = b.z[j + 1] - b.z[j];
      const double square = ds * ds + dz * dz;
      const double k = square > 0 ? std::clamp((s * ds + z * dz) / square, 0.0, 1.0) : 0.0;
      best = std::min(best, std::hypot(s - k * ds, z - k * dz));
    }
    worst = std::max(worst, best);
  }
  return worst;
}

constexpr double kTwoQuanta = 0.01;  // mm: 2 t_q of the default machine on 70 mm

TEST(Directions, GiveTheSameSurface) {
  for (const int points : {0, 20}) {
    ScheduleSpec spec = table1(points);
    spec.motion.direction = Direction::ccw;
    const Replay ccw = path_of(spec);
    spec.motion.direction = Direction::cw;
    const Replay cw = path_of(spec);
    EXPECT_GT(ccw.phi.back(), ccw.phi.front());
    EXPECT_LT(cw.phi.back(), cw.phi.front());
    EXPECT_LE(farthest(ccw, cw, 35.0), kTwoQuanta);
    EXPECT_LE(farthest(cw, ccw, 35.0), kTwoQuanta);
  }
}

TEST(Sectors, LeftAndRightOfAStopJoinToTheWholeCut) {
  ScheduleSpec spec = table1(20);
  const Replay whole = path_of(spec);
  for (const double stop : {50.0, 137.0, 216.5, 300.0}) {
    spec.motion.sector = Sector{Angle::deg(0), Angle::deg(stop), 0.0};
    const Replay left = path_of(spec);
    spec.motion.sector = Sector{Angle::deg(stop), Angle::deg(360 - 1e-4), 5.0};
    const Replay right = path_of(spec);
    EXPECT_LE(farthest(left, whole, 35.0), spec.motion.eps_tip + kTwoQuanta) << stop;
    EXPECT_LE(farthest(right, whole, 35.0), spec.motion.eps_tip + kTwoQuanta) << stop;
    EXPECT_LT(right.phi.front(), stop * kRadPerDeg - 0.5 * 5.0 / 60.0) << "backed up";
    EXPECT_NEAR(left.phi.back(), stop * kRadPerDeg, 1e-4);
  }
}

TEST(Starts, AtAnAngle) {
  ScheduleSpec spec = table1(20);
  for (const double phi : {33.0, 33.3, -20.0}) {
    spec.motion.start = {Start::At::phi, Angle::deg(phi)};
    const Replay path = path_of(spec);
    const double turns = (path.phi.front() - phi * kRadPerDeg) / kTwoPi;
    EXPECT_NEAR(turns, std::round(turns), 1e-6);
    EXPECT_NEAR(path.phi.back() - path.phi.front(), kTwoPi, 1e-9);
  }
}

TEST(Starts, AutomaticallyWhereTheTorchStandsUpright) {
  ScheduleSpec spec = table1(20);
  spec.motion.start.at = Start::At::automatic;
  const Replay path = path_of(spec);
  const auto& b = contour_of(spec).b;
  double least = 1e300;
  for (const double value : b) least = std::min(least, std::abs(value));
  EXPECT_NEAR(std::abs(path.b.front()), least, 1e-6);
}

TEST(Starts, AutomaticallyAwayFromJunctions) {
  ScheduleSpec spec = table1(20);
  Contour& c = contour_of(spec);
  const auto upright = std::ranges::min_element(c.b, {}, [](double b) { return std::abs(b); });
  const auto i = static_cast<std::size_t>(upright - c.b.begin());
  c.corner.assign(c.phi.size(), false);
  c.corner[i] = true;
  spec.motion.start.at = Start::At::automatic;
  const Replay path = path_of(spec);
  EXPECT_GE(35.0 * std::abs(path.phi.front() - c.phi[i]), 3.0);
}

/// Speed of the ideal samples against the table, read by the test's own interpolation.
TEST(SpeedTables, AreKeptAtEverySample) {
  ScheduleSpec spec = table1(20);
  Contour& c = contour_of(spec);
  c.wall = 5.0;
  const SpeedTable table{{{5.0, 30.0}, {8.0, 15.0}, {12.0, 9.0}, {30.0, 4.0}}};
  spec.motion.speed = table;
  const auto job = prepared(spec, {});
  ASSERT_TRUE(job);
  const auto timed = plan(job->course, {}, {});
  ASSERT_TRUE(timed);
  const auto lengths = job->program.lengths();
  const auto speed_at = [&](double u) {
    auto i = static_cast<std::size_t>(std::ranges::upper_bound(lengths, u) - lengths.begin());
    i = std::clamp<std::size_t>(i, 1, lengths.size() - 1);
    const double share = (u - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
    const auto beam_of = [&](std::size_t p) { return 5.0 / std::cos(c.b[p]); };
    const double beam = beam_of(i - 1) + share * (beam_of(i) - beam_of(i - 1));
    std::size_t p = 1;
    while (p + 1 < table.pairs.size() && table.pairs[p].first < beam) ++p;
    const auto& [x0, y0] = table.pairs[p - 1];
    const auto& [x1, y1] = table.pairs[p];
    return y0 + (beam - x0) / (x1 - x0) * (y1 - y0);
  };
  double fastest = 0.0;
  for (std::size_t k = 1; k < timed->places.size(); ++k) {
    const Place &a = timed->places[k - 1], &b = timed->places[k];
    const auto x = job->course.path.at(a.interval, a.offset),
               y = job->course.path.at(b.interval, b.offset);
    const double speed = std::hypot(35.0 * (y[0] - x[0]), y[1] - x[1]) / spec.machine.period;
    const double most =
        std::max(speed_at(a.u(job->course.path.d)), speed_at(b.u(job->course.path.d)));
    EXPECT_LE(speed, most * (1 + 1e-6)) << k;
    fastest = std::max(fastest, speed / most);
  }
  EXPECT_GT(fastest, 0.99);
  const Schedule s = planned(spec);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
}

TEST(SpeedTables, OfAnotherSurface) {
  ScheduleSpec spec = table1(20);
  contour_of(spec).wall = 5.0;
  const double outer = planned(spec).report.ideal;
  spec.motion.speed_on = Surface::inner;
  const Schedule s = planned(spec);
  EXPECT_NE(s.report.ideal, outer);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
}

TEST(Machines, BuiltInOnesAreSound) {
  const auto all = catalogue();
  ASSERT_EQ(all.size(), 4U);
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
  std::get<Crawler>(spec.machine.kinematics).standoff_max.reset();
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

TEST(Reports, SayWhereTheTipIsSlow) {
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
  Contour c;
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
