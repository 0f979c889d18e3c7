// The requested speed: tables by the beam, surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/replay/replay.hpp"
#include "core/motion/timing/plan.hpp"
#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

TEST(Refused, SpeedTableThatDoesNotCoverTheBeam) {
  ScheduleSpec spec = table1(0);
  contour_of(spec).wall = 5.0;
  spec.motion.speed = SpeedTable{{{4.0, 20.0}, {10.0, 10.0}}};
  const Issue issue = refusal(spec);
  EXPECT_EQ(issue.code, ErrorCode::speed_table_range);
  EXPECT_GT(std::get<double>(issue.got), 10.0);
  EXPECT_NE(issue.hint.find("phi"), std::string::npos);
}

/// Speed of the ideal samples against the table, read by the test's own interpolation.
TEST(SpeedTables, AreKeptAtEverySample) {
  ScheduleSpec spec = table1(20);
  CutPath& c = contour_of(spec);
  c.wall = 5.0;
  const SpeedTable table{{{5.0, 30.0}, {8.0, 15.0}, {12.0, 9.0}, {30.0, 4.0}}};
  spec.motion.speed = table;
  const auto job = prepare_cut(spec);
  ASSERT_TRUE(job);
  const auto timed = plan(job->course, {});
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
  for (std::size_t k = 1; k < timed->positions.size(); ++k) {
    const PathPosition &a = timed->positions[k - 1], &b = timed->positions[k];
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

}  // namespace
}  // namespace tubecut::motion::testing
