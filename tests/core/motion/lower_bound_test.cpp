// The plan without jerk limits against a bound from below: the time of u(t) is a convex function of
// x = u_dot^2 at the knots, so its tangent at any point, minimised over the limits by GLPK, lies
// below every time. The limits are applied only at three points of every interval, with derivatives
// by differences of the axis values, which is less than the planner must hold.
#include <glpk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/motion/replay/replay.hpp"
#include "core/motion/timing/plan.hpp"
#include "tests/core/motion/jobs.hpp"
#include "tests/core/motion/random_jobs.hpp"

namespace tubecut::motion::testing {
namespace {

constexpr int kJobsInEveryRun = 12;  // TUBECUT_JOBS=200 is the full acceptance run

int job_count() {
  const char* const wanted = std::getenv("TUBECUT_JOBS");
  return wanted == nullptr ? kJobsInEveryRun : std::max(1, std::atoi(wanted));
}

/// q' and q'' at a place, by central differences inside the interval: exact for a cubic.
std::array<double, 2> differences(const Path& path, const AxisFunction& f, std::size_t i,
                                  double offset) {
  constexpr double h = 0.001;
  const double before = f.at(path.at(i, offset - h)), here = f.at(path.at(i, offset));
  const double after = f.at(path.at(i, offset + h));
  return {(after - before) / (2.0 * h), (after - 2.0 * here + before) / (h * h)};
}

/// All limits at three places of every interval, as rows over x at the knots.
class Relaxation {
 public:
  explicit Relaxation(const Course& course)
      : course_(course), lp_(glp_create_prob()), knots_(course.limits.intervals() + 1) {
    glp_set_obj_dir(lp_, GLP_MAX);
    glp_add_cols(lp_, static_cast<int>(knots_));
    for (std::size_t j = 0; j < knots_; ++j) {
      const bool end = j == 0 || j + 1 == knots_;
      glp_set_col_bnds(lp_, static_cast<int>(j) + 1, end ? GLP_FX : GLP_LO, 0.0, 0.0);
    }
    for (std::size_t i = 0; i + 1 < knots_; ++i) {
      for (const double share : {0.01, 0.5, 0.99}) add_place(i, share);
    }
  }
  Relaxation(const Relaxation&) = delete;
  Relaxation& operator=(const Relaxation&) = delete;
  ~Relaxation() { glp_delete_prob(lp_); }

  /// The x within the limits with the largest weighted sum.
  std::vector<double> largest(const std::vector<double>& weights) {
    for (std::size_t j = 0; j < knots_; ++j) {
      glp_set_obj_coef(lp_, static_cast<int>(j) + 1, weights[j]);
    }
    glp_smcp options;
    glp_init_smcp(&options);
    options.msg_lev = GLP_MSG_OFF;
    options.presolve = GLP_OFF;
    EXPECT_EQ(glp_simplex(lp_, &options), 0);
    EXPECT_EQ(glp_get_status(lp_), GLP_OPT);
    std::vector<double> x;
    for (std::size_t j = 0; j < knots_; ++j) {
      x.push_back(std::max(0.0, glp_get_col_prim(lp_, static_cast<int>(j) + 1)));
    }
    return x;
  }

 private:
  void add_place(std::size_t i, double share) {
    const Course& c = course_;
    double tip = 0.0;
    for (const AxisFunction& f : c.tip) {
      const double first = differences(c.path, f, i, share * c.path.d)[0];
      tip += first * first;
    }
    const double speed = c.speed.least(0.0, c.path.length());
    add(i, share, 0.0, tip / (speed * speed), 1.0);
    for (std::size_t a = 0; a < c.axes.size(); ++a) {
      const Axis& axis = c.machine.axes[a];
      const auto [first, second] = differences(c.path, c.axes[a], i, share * c.path.d);
      const double v = velocity_limit(axis, c.machine.period);
      add(i, share, 0.0, first * first / (v * v), 1.0);
      if (std::abs(first) + std::abs(second) < 1e-7) continue;
      add(i, share, first, second, axis.a_max);
      add(i, share, -first, -second, axis.a_max);
    }
  }
  /// per_acceleration u_ddot + per_x x <= c at `share` of interval i.
  void add(std::size_t i, double share, double per_acceleration, double per_x, double c) {
    const double w = 0.5 * per_acceleration / course_.path.d;
    const double start = per_x * (1.0 - share) - w, end = per_x * share + w;
    const double size = std::max(std::abs(start), std::abs(end));
    if (size == 0.0) return;
    const int row = glp_add_rows(lp_, 1);
    glp_set_row_bnds(lp_, row, GLP_UP, 0.0, c / size);
    const std::array<int, 3> columns{0, static_cast<int>(i) + 1, static_cast<int>(i) + 2};
    const std::array<double, 3> values{0.0, start / size, end / size};
    glp_set_mat_row(lp_, row, 2, columns.data(), values.data());
  }

  const Course& course_;
  glp_prob* lp_;
  std::size_t knots_;
};

double time_of(const std::vector<double>& x, double d) {
  double time = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    time += 2.0 * d / (std::sqrt(x[i - 1]) + std::sqrt(x[i]));
  }
  return time;
}

/// Minus the slope of the time in each x; at the ends x is fixed.
std::vector<double> gains(const std::vector<double>& x, double d) {
  std::vector<double> out(x.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double s = std::sqrt(x[i]);
    for (const std::size_t j : {i - 1, i + 1}) {
      const double sum = s + std::sqrt(x[j]);
      out[i] += d / (s * sum * sum);
    }
  }
  return out;
}

/// A bound below every time: tangents at the plan and on the way from it to their minimiser.
double lower_bound(Relaxation& limits, std::vector<double> x, double d, double good_enough) {
  double best = 0.0;
  for (int tangent = 0; tangent < 4 && best < good_enough; ++tangent) {
    const std::vector<double> slope = gains(x, d);
    const std::vector<double> to = limits.largest(slope);
    double bound = time_of(x, d);
    for (std::size_t i = 0; i < x.size(); ++i) bound -= slope[i] * (to[i] - x[i]);
    best = std::max(best, bound);
    std::vector<double> next = x, trial = x;
    for (double step = 1.0; step > 1e-3; step *= 0.7) {
      for (std::size_t i = 0; i < x.size(); ++i) trial[i] = x[i] + step * (to[i] - x[i]);
      if (time_of(trial, d) < time_of(next, d)) next = trial;
    }
    x = next;
  }
  return best;
}

/// A short wavy cut that acceleration binds, on a random machine: five axes, crawler or plain maps.
ScheduleSpec bound_job(std::uint64_t seed) {
  Dice dice(9000 + seed);
  ScheduleSpec spec = random_job(seed);
  CutPath c;
  c.outer_radius = dice.uniform(20.0, 80.0);
  c.wall = 0.1 * c.outer_radius;
  c.closed = false;
  const double length = dice.uniform(12.0, 24.0), waves = dice.uniform(0.5, 3.0);
  const double height = dice.uniform(0.1, 0.6) * length / waves;
  const double bevel = dice.below(2) == 0 ? 0.0 : dice.uniform(0.05, 0.4);
  const double shift = dice.uniform(0.0, kTwoPi);
  for (int i = 0; i <= 80; ++i) {
    const double share = i / 80.0;
    c.phi.push_back(0.7 * length * share / c.outer_radius);
    c.z.push_back(height * std::sin(kTwoPi * waves * share + shift));
    c.b.push_back(bevel * std::cos(kTwoPi * waves * share));
  }
  spec.cut = c;
  if (dice.below(3) == 0) {
    spec.machine.kinematics = Generic{{{.k_phi = 1.0}, {.k_z = 1.0}, {.k_b = 1.0}}};
    spec.machine.axes.erase(spec.machine.axes.begin() + 3, spec.machine.axes.end());
  }
  for (Axis& axis : spec.machine.axes) axis.a_max *= dice.log_uniform(0.05, 1.0);
  spec.machine.period = 0.001;
  spec.motion.speed = dice.log_uniform(10.0, 300.0);
  spec.motion.jerk = false;
  return spec;
}

TEST(LowerBound, IsReachedWithoutJerkToOnePercent) {
  const int jobs = job_count();
  double worst = 0.0, slowest_before = 0.0;
  int bound = 0;
  for (int seed = 1; seed <= jobs; ++seed) {
    const ScheduleSpec spec = bound_job(static_cast<std::uint64_t>(seed));
    const auto job = prepare_cut(spec);
    ASSERT_TRUE(job) << seed;
    const Course& course = job->course;
    const auto made = plan(course, {.jerk = false});
    ASSERT_TRUE(made) << seed;
    EXPECT_LE(made->uses.worst(), 1.0 + 1e-8) << seed;
    EXPECT_EQ(made->stretch, 1.0) << seed;
    const double d = course.limits.d, time = made->timing.time;
    Relaxation limits(course);
    const double least = lower_bound(limits, made->timing.x, d, time / 1.002);
    EXPECT_LE(time, 1.01 * least) << seed;
    EXPECT_LE(time, 1.01 * made->least) << seed;
    const Conditions base = without_jerk(course.limits);
    const double before = duration(largest_profile(base.caps, d, base.rows), d);
    EXPECT_LE(time, before) << seed;
    bound += before > 1.01 * time ? 1 : 0;
    worst = std::max(worst, time / least);
    slowest_before = std::max(slowest_before, before / least);
  }
  EXPECT_GE(bound, jobs / 4);  // in many of them terms cancel
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("worst_by_magnitudes", std::to_string(slowest_before));
  RecordProperty("cancelling", bound);
}

/// C and Z over an open wave; `per_s` is jerk over acceleration.
ScheduleSpec wave(std::optional<double> per_s) {
  ScheduleSpec spec;
  CutPath c;
  c.outer_radius = 57.15;
  c.wall = 5.0;
  c.closed = false;
  for (int i = 0; i < 721; ++i) {
    const double phi = kTwoPi * i / 720;
    c.phi.push_back(phi);
    c.z.push_back(53.0 * std::sin(4.0 * phi));
    c.b.push_back(0.0);
  }
  spec.cut = c;
  Axis turn{
      .name = "C", .unit = AxisUnit::deg, .pulses_per_turn = 360000, .v_max = 240, .a_max = 20};
  Axis z{.name = "Z", .pulses_per_unit = 1000, .v_max = 800, .a_max = 300};
  if (per_s) {
    turn.j_max = *per_s * turn.a_max;
    z.j_max = *per_s * z.a_max;
  }
  spec.machine = {.period = 0.004, .axes = {turn, z}};
  spec.machine.kinematics = Generic{{{.k_phi = 1.0}, {.k_z = 1.0}}};
  spec.motion.speed = 20000.0 / 60.0;
  spec.motion.jerk = per_s.has_value();
  return spec;
}

void expect_verified(const ScheduleSpec& spec, const Schedule& s) {
  for (const Check& check : verify(spec, s)) {
    EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " > " << check.limit;
  }
}

/// A profile that holds every limit takes 11.51 s; sums of magnitudes take 29.45 s.
TEST(LowerBound, WaveWhoseTermsCancel) {
  const ScheduleSpec spec = wave({});
  const Schedule s = planned(spec);
  EXPECT_LE(s.report.time, 1.01 * 11.51);
  EXPECT_GE(s.report.optimality, 1.0);
  EXPECT_LE(s.report.optimality, 1.01);
  expect_verified(spec, s);
}

/// With jerk limits the wave is faster than any plan by magnitudes, even one without jerk limits.
TEST(LowerBound, WaveWithJerkBeatsMagnitudesWithout) {
  for (const double per_s : {20.0, 100.0, 500.0}) {
    const ScheduleSpec spec = wave(per_s);
    const auto job = prepare_cut(spec);
    ASSERT_TRUE(job);
    const PathLimits& limits = job->course.limits;
    const Conditions base = without_jerk(limits);
    const double magnitudes = duration(largest_profile(base.caps, limits.d, base.rows), limits.d);
    const Schedule s = planned(spec);
    EXPECT_LE(s.report.time, 0.9 * magnitudes) << per_s;
    EXPECT_LE(s.report.time, s.report.proven + spec.machine.period) << per_s;
    EXPECT_GE(s.report.time, s.report.no_jerk) << per_s;
    EXPECT_EQ(s.report.stretch, 1.0) << per_s;
    expect_verified(spec, s);
  }
}

}  // namespace
}  // namespace tubecut::motion::testing
