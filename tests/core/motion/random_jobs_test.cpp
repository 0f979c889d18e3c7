// Seeded random jobs: every invariant holds, times lie between the floors and the proven mode.
#include "tests/core/motion/random_jobs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/motion/path/course.hpp"
#include "core/motion/replay/reconstruction.hpp"
#include "core/motion/replay/replay.hpp"
#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

constexpr int kJobsInEveryRun = 60;  // TUBECUT_JOBS=2000 is the full acceptance run

int job_count() {
  const char* const wanted = std::getenv("TUBECUT_JOBS");
  return wanted == nullptr ? kJobsInEveryRun : std::max(1, std::atoi(wanted));
}

/// Length of the tip's path proven by only the counts: chords over many periods, less the quantum
/// at both ends.
double proven_length(const ScheduleSpec& spec, const Schedule& s) {
  const auto& contour = std::get<CutPath>(spec.cut);
  const Reconstruction torch(spec);
  const double rho =
      spec.motion.speed_on == Surface::outer ? contour.outer_radius : contour.inner_radius();
  const double largest = 75.0 * kRadPerDeg;
  const Coordinates quantum = torch.quantum(largest);
  const double off = std::abs(rho - contour.radius());
  const double slack = 2.0 * std::hypot(rho * quantum[0], quantum[1] + off * 15.0 * quantum[2]);
  std::vector<double> q;
  std::vector<std::int64_t> sum(s.axes.size(), 0);
  for (const AxisPulses& axis : s.axes) q.push_back(axis.start);
  const auto trace = [&] {
    const Coordinates x = torch.at(q);
    const double z = x[1] - spec.machine.sigma() * (rho - contour.radius()) * std::tan(x[2]);
    return std::pair{rho * x[0], z};
  };
  auto from = trace();
  double length = 0.0;
  for (std::int64_t k = 1; k <= s.periods; ++k) {
    for (std::size_t a = 0; a < q.size(); ++a) {
      if (s.axes[a].idle()) continue;
      sum[a] += s.axes[a].counts[static_cast<std::size_t>(k - 1)];
      q[a] = s.axes[a].start +
             static_cast<double>(sum[a]) / spec.machine.axes[a].pulses_per_axis_unit();
    }
    if (k % 20 != 0) continue;
    const auto to = trace();
    length += std::max(0.0, std::hypot(to.first - from.first, to.second - from.second) - slack);
    from = to;
  }
  return length;
}

struct Figures {
  int stretched = 0;
  std::vector<double> over_no_jerk;
};

void examine(std::uint64_t seed, Figures& figures) {
  const ScheduleSpec spec = random_job(seed);
  const auto s = schedule(spec);
  ASSERT_TRUE(s) << "job " << seed << ": " << info(s.error().code()).code;
  for (const Check& check : verify(spec, *s)) {
    EXPECT_TRUE(check.passed()) << "job " << seed << " " << check.name << " " << check.value
                                << " > " << check.limit << " " << check.unit;
  }
  figures.stretched += s->report.stretch != 1.0 ? 1 : 0;
  figures.over_no_jerk.push_back(s->report.time / s->report.no_jerk);
  EXPECT_LE(s->report.time, s->report.proven + spec.machine.period) << seed;
  EXPECT_GE(s->report.time, proven_length(spec, *s) / std::get<double>(spec.motion.speed)) << seed;
}

TEST(RandomJobs, HoldEveryInvariant) {
  Figures figures;
  const int jobs = job_count();
  for (int seed = 1; seed <= jobs; ++seed) examine(static_cast<std::uint64_t>(seed), figures);
  auto& ratio = figures.over_no_jerk;
  ASSERT_EQ(ratio.size(), static_cast<std::size_t>(jobs));
  std::ranges::sort(ratio);
  EXPECT_LE(ratio[ratio.size() / 2], 1.01);
  EXPECT_LE(ratio[ratio.size() * 9 / 10], 1.2);
  EXPECT_LE(figures.stretched, jobs / 1000);
  RecordProperty("median", std::to_string(ratio[ratio.size() / 2]));
  RecordProperty("percent_90", std::to_string(ratio[ratio.size() * 9 / 10]));
  RecordProperty("worst", std::to_string(ratio.back()));
  RecordProperty("stretched", figures.stretched);
}

/// The proven mode by itself never needs repair, and the returned plan is never slower.
TEST(RandomJobs, NeverSlowerThanTheProvenMode) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    ScheduleSpec spec = random_job(seed);
    const Schedule best = planned(spec);
    spec.motion.expert.optimism = 1.0;
    const Schedule proven = planned(spec);
    EXPECT_LE(best.periods, proven.periods) << seed;
    EXPECT_EQ(proven.report.stretch, 1.0) << seed;
    for (const Check& check : verify(spec, proven)) EXPECT_TRUE(check.passed()) << check.name;
  }
}

}  // namespace
}  // namespace tubecut::motion::testing
