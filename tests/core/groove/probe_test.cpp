#include "core/groove/probe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/groove/path_cases.hpp"

namespace tubecut::groove {
namespace {

using namespace testing;

class Probes : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    spec = path_case(GetParam());
    path = *mill_path(spec);
  }
  [[nodiscard]] Probe asked(const std::vector<ProbePoint>& points) const {
    auto found = probe(spec, path, points);
    EXPECT_TRUE(found.has_value());
    return found.value_or(Probe{});
  }
  MillPathSpec spec;
  MillPath path;
};
INSTANTIATE_TEST_SUITE_P(Cases, Probes,
                         ::testing::Values("A_source_like", "B_near_equal", "C_oblique_offset"));

TEST_P(Probes, TheDistanceAtAContactIsItsGap) {
  std::vector<ProbePoint> points;
  std::vector<double> before, after;
  for (std::size_t k = 0; k < path.positions.size(); k += 37) {
    const auto& p = path.positions[k];
    for (std::size_t i = 0; i < p.after.gap.size(); ++i) {
      const double v = double(i) / double(p.after.gap.size() - 1);
      points.push_back({p.omega, p.omega + Angle::rad(p.before.offset[i]), v});
      points.push_back({p.omega, p.omega + Angle::rad(p.after.offset[i]), v});
      before.push_back(p.before.gap[i]);
      after.push_back(p.after.gap[i]);
    }
  }
  ASSERT_GT(before.size(), 50u);
  const auto seen = asked(points);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(seen.points[2 * i].before, before[i], 1e-9);
    EXPECT_NEAR(seen.points[2 * i + 1].after, after[i], 1e-9);
  }
}

TEST_P(Probes, TheFirstPositionLiesOnItsOwnRuling) {
  std::vector<ProbePoint> points;
  for (int i = 0; i < 50; ++i)
    points.push_back({Angle::deg(7.3 * i), Angle::deg(7.3 * i), 0.02 * i});
  for (const auto& one : asked(points).points) EXPECT_NEAR(one.before, 0.0, 1e-9);
}

TEST_P(Probes, NoContactIsDeeperThanTheDeepestPlace) {
  const auto seen = asked({{Angle::deg(10), Angle::deg(10), 0.5}});
  double over = 0.0, under = 0.0, over_before = 0.0;
  for (const auto& p : path.positions) {
    over = std::max(over, p.after.over);
    under = std::max(under, p.after.under);
    over_before = std::max(over_before, p.before.over);
  }
  EXPECT_GT(over, 0.0);
  EXPECT_EQ(-seen.after.over.distance, over);
  EXPECT_EQ(seen.after.under.distance, under);
  EXPECT_EQ(-seen.before.over.distance, over_before);
  const auto again = asked({seen.after.over.at, seen.after.under.at});
  EXPECT_NEAR(again.points[0].after, seen.after.over.distance, 1e-9);
  EXPECT_NEAR(again.points[1].after, seen.after.under.distance, 1e-9);
  EXPECT_LT((again.points[0].point - seen.after.over.point).norm(), 1e-9);
}

TEST_P(Probes, BetweenPositionsTheAxesRunLinearly) {
  for (const std::size_t k : {std::size_t{3}, path.positions.size() - 1}) {
    const auto& from = path.positions[k];
    const auto& to = path.positions[(k + 1) % path.positions.size()];
    const double turn = k + 1 == path.positions.size() ? 360.0 : 0.0;
    const Angle middle = Angle::deg(0.5 * (from.omega.deg() + to.omega.deg() + turn));
    const auto at = asked({{middle, middle, 0.5}}).points[0].at;
    EXPECT_NEAR(at.x, 0.5 * (from.at.x + to.at.x), 1e-9);
    EXPECT_NEAR(at.z, 0.5 * (from.at.z + to.at.z), 1e-9);
    EXPECT_NEAR(at.b.rad(), 0.5 * (from.at.b.rad() + to.at.b.rad()), 1e-9);
  }
}

TEST_P(Probes, ItsProofSeesAWrongDistance) {
  const std::vector<ProbePoint> points{{Angle::deg(100.1), Angle::deg(101), 0.3},
                                       {Angle::deg(-50), Angle::deg(-48), 1.0}};
  auto seen = asked(points);
  EXPECT_TRUE(verify(spec, points, seen).passed());
  seen.points[1].after += 1e-6;
  EXPECT_FALSE(verify(spec, points, seen).passed());
  seen.points[1].after = std::nan("");
  EXPECT_FALSE(verify(spec, points, seen).passed());
}

}  // namespace
}  // namespace tubecut::groove
