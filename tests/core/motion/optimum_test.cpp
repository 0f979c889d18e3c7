// The profile by sums of magnitudes against a linear programme over the spec's rows, solved by
// GLPK.
#include <glpk.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/path/course.hpp"
#include "tests/core/motion/jobs.hpp"
#include "tests/core/motion/random_jobs.hpp"

namespace tubecut::motion::testing {
namespace {

/// Maximises the sum of x at the knots: a componentwise largest vector exists, so this is it.
class LargestVector {
 public:
  LargestVector(const Conditions& conditions, double d)
      : lp_(glp_create_prob()), n_(static_cast<int>(conditions.caps.size())) {
    glp_set_obj_dir(lp_, GLP_MAX);
    glp_add_cols(lp_, n_);
    for (int j = 0; j < n_; ++j) {
      const double cap = conditions.caps[static_cast<std::size_t>(j)];
      glp_set_col_bnds(lp_, j + 1, cap > 0 ? GLP_DB : GLP_FX, 0.0, cap);
      glp_set_obj_coef(lp_, j + 1, 1.0);
    }
    for (std::size_t i = 0; i + 1 < conditions.rows.first.size(); ++i) {
      for (std::size_t r = conditions.rows.first[i]; r < conditions.rows.first[i + 1]; ++r) {
        add(static_cast<int>(i) + 1, conditions.rows.rows[r], d);
      }
    }
  }
  LargestVector(const LargestVector&) = delete;
  LargestVector& operator=(const LargestVector&) = delete;
  ~LargestVector() { glp_delete_prob(lp_); }

  std::vector<double> solve() {
    glp_smcp options;
    glp_init_smcp(&options);
    options.msg_lev = GLP_MSG_ERR;
    options.tol_bnd = 1e-10;
    options.tol_dj = 1e-10;
    EXPECT_EQ(glp_simplex(lp_, &options), 0);
    EXPECT_EQ(glp_get_status(lp_), GLP_OPT);
    std::vector<double> x;
    for (int j = 1; j <= n_; ++j) x.push_back(glp_get_col_prim(lp_, j));
    return x;
  }

 private:
  /// alpha |b_ - a_| / 2d + beta x <= c at both knots, each sign a row of its own.
  void add(int knot, const Row& row, double d) {
    if (row.alpha == 0.0 && row.beta == 0.0) return;
    const double k = row.alpha / (2.0 * d);
    add(knot, -k, k + row.beta, row.c);
    add(knot, k + row.beta, -k, row.c);
    add(knot, row.beta - k, k, row.c);
    add(knot, k, row.beta - k, row.c);
  }
  void add(int knot, double a, double b, double c) {
    const double size = std::max(std::abs(a), std::abs(b));
    const int row = glp_add_rows(lp_, 1);
    glp_set_row_bnds(lp_, row, GLP_UP, 0.0, c / size);
    const std::array<int, 3> columns{0, knot, knot + 1};
    const std::array<double, 3> values{0.0, a / size, b / size};
    glp_set_mat_row(lp_, row, 2, columns.data(), values.data());
  }
  glp_prob* lp_;
  int n_;
};

/// A short open cut with the random job's machine: few knots, all kinds of spoilt contour.
ScheduleSpec short_job(std::uint64_t seed) {
  ScheduleSpec spec = random_job(seed);
  auto& c = std::get<CutPath>(spec.cut);
  const std::size_t n = 12;
  c.phi.resize(n);
  c.z.resize(n);
  c.b.resize(n);
  const double share = 15.0 / (c.outer_radius * (c.phi.back() - c.phi.front()));
  for (double& phi : c.phi) phi *= share;
  for (double& z : c.z) z *= share;
  c.closed = false;
  return spec;
}

TEST(Optimum, OfTheMagnitudesIsALinearProgramme) {
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ScheduleSpec spec = short_job(seed);
    const auto job = prepare_cut(spec);
    ASSERT_TRUE(job) << seed;
    const PathLimits& limits = job->course.limits;
    const std::vector<double> x = LargestVector(without_jerk(limits), limits.d).solve();
    double time = 0.0;
    for (std::size_t i = 1; i < x.size(); ++i) {
      time += 2.0 * limits.d / (std::sqrt(x[i - 1]) + std::sqrt(x[i]));
    }
    const Conditions base = without_jerk(limits);
    const std::vector<double> passes = largest_profile(base.caps, limits.d, base.rows);
    EXPECT_NEAR(duration(passes, limits.d), time, 1e-9 * time) << seed << " knots " << x.size();
    ++solved;
  }
  EXPECT_EQ(solved, 20);
}

}  // namespace
}  // namespace tubecut::motion::testing
