#include <glpk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/angle.hpp"
#include "core/bevel/smoothing/least_area.hpp"
#include "tests/core/bevel/real_nodes.hpp"

/// The envelope's area against the linear programme it approximates, solved by GLPK.
namespace tubecut::bevel {
namespace {

constexpr double kTorch = 80.0 * kRadPerDeg;

/// Least area of any f >= B, f <= highest, |slope| <= K, |second difference| <= A at the same
/// nodes; uniform spacing h. Unknown: f - B in degrees.
class LinearProgramme {
 public:
  LinearProgramme(const AngleProfile& profile, const BevelRateLimits& limits, double highest)
      : b_(profile.b),
        h_(profile.period / static_cast<double>(profile.b.size())),
        problem_(glp_create_prob()) {
    const int n = static_cast<int>(b_.size());
    glp_term_out(GLP_OFF);
    glp_set_obj_dir(problem_, GLP_MIN);
    glp_add_cols(problem_, n);
    glp_add_rows(problem_, 2 * n);
    for (int j = 0; j < n; ++j) {
      glp_set_col_bnds(problem_, j + 1, GLP_DB, 0.0,
                       std::max((highest - at(j)) * kDegPerRad, 1e-9));
      glp_set_obj_coef(problem_, j + 1, h_);
      row(2 * j + 1, limits.slope * h_, {{j, -1.0}, {j + 1, 1.0}});
      row(2 * j + 2, limits.curvature * h_ * h_, {{j, 1.0}, {j + 1, -2.0}, {j + 2, 1.0}});
    }
  }
  ~LinearProgramme() { glp_delete_prob(problem_); }
  LinearProgramme(const LinearProgramme&) = delete;
  LinearProgramme& operator=(const LinearProgramme&) = delete;

  /// Minimises f - B at one node instead of the area.
  void only(std::size_t node) {
    for (std::size_t j = 0; j < b_.size(); ++j)
      glp_set_obj_coef(problem_, static_cast<int>(j) + 1, j == node ? 1.0 : 0.0);
  }

  double least() {
    glp_smcp options;
    glp_init_smcp(&options);
    options.msg_lev = GLP_MSG_OFF;
    options.meth =
        GLP_DUALP;  // f = highest is feasible, area has no negative cost: the dual starts feasible
    EXPECT_EQ(glp_simplex(problem_, &options), 0);
    EXPECT_EQ(glp_get_status(problem_), GLP_OPT);
    return glp_get_obj_val(problem_);
  }

 private:
  struct Term {
    int node;
    double factor;
  };
  double at(int j) const { return b_[static_cast<std::size_t>(j) % b_.size()]; }

  /// |sum factor f| <= bound, f = B + unknown.
  void row(int index, double bound, const std::vector<Term>& terms) {
    std::vector<int> columns{0};
    std::vector<double> factors{0.0};
    double known = 0.0;
    for (const auto& term : terms) {
      columns.push_back(term.node % static_cast<int>(b_.size()) + 1);
      factors.push_back(term.factor);
      known += term.factor * at(term.node);
    }
    glp_set_mat_row(problem_, index, static_cast<int>(terms.size()), columns.data(),
                    factors.data());
    glp_set_row_bnds(problem_, index, GLP_DB, (-bound - known) * kDegPerRad,
                     (bound - known) * kDegPerRad);
  }

  std::vector<double> b_;
  double h_;
  glp_prob* problem_;
};

/// The area is GLPK's, and the multipliers prove it without GLPK.
void compare(unsigned long seed, int nodes, std::size_t points, BevelRateLimits limits,
             double highest) {
  std::mt19937_64 random(seed);
  double worst = 0.0, proved = 0.0;
  for (int seen = 0; seen < nodes;) {
    const auto profile = real_nodes::random_node(random, points, kTorch);
    const EnvelopeSpec spec{.limits = limits, .highest = highest};
    const double least = LinearProgramme(profile, limits, std::min(highest, 2.0)).least();
    if (least < 1e-3) continue;  // nothing to smooth: no ratio
    ++seen;
    const auto out = envelope(profile, spec);
    ASSERT_TRUE(out);
    const double area = area_above(profile, out->b);
    worst = std::max(worst, std::abs(area * kDegPerRad / least - 1.0));
    proved = std::max(proved, area_excess(profile, spec, out->multipliers, area));
  }
  EXPECT_LE(worst, 1e-6);
  EXPECT_LE(proved, 1e-6);
  ::testing::Test::RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
  ::testing::Test::RecordProperty("proved", std::to_string(proved * 1e9) + "e-9");
}

constexpr BevelRateLimits kSlow{5.0 * kRadPerDeg, 1.0 * kRadPerDeg};

TEST(EnvelopeOptimum, HundredRealNodes) { compare(20240501, 100, 360, kSlow, 1e9); }

TEST(EnvelopeOptimum, UnderTheTorchLimit) { compare(20240502, 100, 360, kSlow, kTorch); }

/// At 8 deg/mm, 4 deg/mm^2 a node spacing is up to half the length K/A: curves that bend between
/// nodes lose more.
TEST(EnvelopeOptimum, FasterAxis) {
  compare(20240503, 100, 360, {8.0 * kRadPerDeg, 4.0 * kRadPerDeg}, 1e9);
}

/// One corner among 20 000 nodes: the rounding errors of the others must not add up round the path.
TEST(EnvelopeOptimum, OneCornerAmongTwentyThousandNodes) {
  constexpr std::size_t n = 20000;
  for (const double kink : {1e-4, 0.01, 1.0}) {
    AngleProfile profile{.s = {}, .b = {}, .period = 400.0};
    for (std::size_t j = 0; j < n; ++j) {
      const double s = profile.period * static_cast<double>(j) / n;
      profile.s.push_back(s);
      profile.b.push_back(0.3 * std::sin(kTwoPi * s / profile.period) +
                          kink * std::max(0.0, 1.0 - std::abs(s - 130.0) / 40.0));
    }
    const EnvelopeSpec spec{.limits = kSlow, .highest = kTorch};
    const auto out = envelope(profile, spec);
    ASSERT_TRUE(out);
    const double area = area_above(profile, out->b);
    EXPECT_LE(area_excess(profile, spec, out->multipliers, area), 1e-6) << kink;
    const auto steep = steepness({profile.s, out->b, profile.period});
    const auto most = allowed_steepness({profile.s, out->b, profile.period}, spec.limits);
    EXPECT_LE(steep.slope, most.slope);
    EXPECT_LE(steep.second, most.second);
  }
}

/// Any multipliers prove a bound below the area of every profile that keeps the limits.
TEST(LeastArea, NoMultipliersProveMoreThanIsTrue) {
  std::mt19937_64 random(20240505);
  std::normal_distribution<double> noise;
  for (int i = 0; i < 200; ++i) {
    const auto profile = real_nodes::random_node(random, 90, kTorch);
    const EnvelopeSpec spec{.limits = kSlow, .highest = kTorch};
    const auto out = *envelope(profile, spec);
    const double area = area_above(profile, out.b);
    for (const double size : {1e-6, 1e-3, 1.0}) {
      auto wild = out.multipliers;
      for (double& m : wild.contact) m *= 1.0 + size * noise(random);
      for (double& m : wild.slope) m += size * noise(random);
      EXPECT_LE(least_area(profile, spec, wild, area), area * (1.0 + 1e-9) + 1e-12) << i;
    }
    EXPECT_NEAR(least_area(profile, spec, no_multipliers(profile), area), 0.0, 1e-12) << i;
  }
}

/// Multipliers of another table, missing ones, or NaN prove nothing, and the check fails.
TEST(LeastArea, MissingMultipliersProveNothing) {
  std::mt19937_64 random(20240507);
  const auto profile = real_nodes::random_node(random, 90, kTorch);
  const EnvelopeSpec spec{.limits = kSlow, .highest = kTorch};
  const auto good = envelope(profile, spec)->multipliers;
  const auto passes = [&](const Multipliers& m) {
    return area_excess(profile, spec, m, 1.0) <= 1e-6;
  };
  EXPECT_FALSE(passes({}));
  auto other = good;
  other.contact.pop_back();
  EXPECT_FALSE(passes(other));
  for (auto member : {&Multipliers::contact, &Multipliers::slope}) {
    other = good;
    (other.*member)[3] = std::nan("");
    EXPECT_FALSE(passes(other));
  }
}

/// A profile that is not the least is seen: twice the excess of anything that lies above it.
TEST(LeastArea, AWorseProfileIsDetected) {
  std::mt19937_64 random(20240506);
  for (int i = 0; i < 50; ++i) {
    const auto profile = real_nodes::random_node(random, 180, kTorch);
    const EnvelopeSpec spec{.limits = kSlow};
    const auto out = *envelope(profile, spec);
    const double area = area_above(profile, out.b);
    if (area < 1e-3) continue;
    EXPECT_LE(area_excess(profile, spec, out.multipliers, area), 1e-6) << i;
    EXPECT_GT(area_excess(profile, spec, out.multipliers, area * (1.0 + 2e-6)), 1e-6) << i;
  }
}

/// Nodes further than (largest step)/K + 2K/A from every break of a limit keep their bits, or no
/// curve within the limits could have kept them.
TEST(EnvelopeOptimum, FarNodesChangeOnlyWhenTheyMust) {
  std::mt19937_64 random(20240504);
  const BevelRateLimits limits{5.0 * kRadPerDeg, 4.0 * kRadPerDeg};
  int far = 0;
  int changed = 0;
  for (int i = 0; i < 200; ++i) {
    const auto p = real_nodes::random_node(random, 360, kTorch);
    const auto f = envelope(p, {.limits = limits})->b;
    const double h = p.period / 360.0;
    std::vector<double> broken;
    double step = 0.0;
    for (std::size_t j = 0; j < 360; ++j) {
      const double in = (p.b[j] - p.b[(j + 359) % 360]) / h;
      const double out = (p.b[(j + 1) % 360] - p.b[j]) / h;
      step = std::max(step, std::abs(out) * h);
      if (std::max(std::abs(in), std::abs(out)) > limits.slope ||
          std::abs(out - in) > limits.curvature * h)
        broken.push_back(p.s[j]);
    }
    for (std::size_t j = 0; j < 360; ++j) {
      double nearest = p.period;
      for (const double s : broken)
        nearest = std::min({nearest, std::abs(p.s[j] - s), p.period - std::abs(p.s[j] - s)});
      if (nearest <= step / limits.slope + 2.0 * limits.slope / limits.curvature) continue;
      ++far;
      if (f[j] == p.b[j]) continue;
      ++changed;
      LinearProgramme programme(p, limits, 2.0);
      programme.only(j);
      EXPECT_GT(programme.least(), 1e-6) << i << ' ' << j;
    }
  }
  EXPECT_GT(far, 20000);
  EXPECT_GT(changed, 0);  // or the comment in envelope_test.cpp is wrong
}

}  // namespace
}  // namespace tubecut::bevel
