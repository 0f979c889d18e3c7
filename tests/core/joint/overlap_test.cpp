#include "core/joint/node/overlap.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <random>

#include "tests/support/cancelled.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

Member tube(const char* name, Vector3d start, Vector3d finish, double diameter, double wall,
            int priority = 1) {
  return {.start = std::move(start),
          .finish = std::move(finish),
          .outer_radius = 0.5 * diameter,
          .wall = wall,
          .priority = priority,
          .name = name};
}

std::vector<Overlap> found(const NodeSpec& spec) {
  const auto nodes = solve(spec);
  EXPECT_TRUE(nodes);
  auto out = overlaps(spec, *nodes);
  EXPECT_TRUE(out);
  return *out;
}

Member chord() { return tube("C", {-1500, 0, 0}, {1500, 0, 0}, 219.1, 10, 0); }
/// A brace at 45 deg on the chord, its foot at x; `side` which way it leans.
Member brace(const char* name, double x, double side) {
  return tube(name, {x, 0, 0}, {x + 1000 * side, 0, 1000}, 114.3, 5);
}
/// Both braces joined only with the chord.
NodeSpec k_joint(double apart) {
  NodeSpec spec{.members = {chord(), brace("L", -apart / 2, -1), brace("R", apart / 2, 1)},
                .connect = {}};
  spec.connect = std::vector<Link>{{1, End::start, {0}}, {2, End::start, {0}}};
  return spec;
}

// On the chord's crown line both braces' outer surfaces are straight lines at 45 deg, 57.15 sqrt 2
// from their feet: the toes touch if those meet on the crown, 2 (109.55 - 57.15 sqrt 2) before.
TEST(Overlap, ToesTouchAtTheComputedDistance) {
  const double touching = 2.0 * (57.15 * std::sqrt(2.0) - 109.55);
  EXPECT_TRUE(found(k_joint(touching + 0.1)).empty());
  EXPECT_TRUE(found(k_joint(touching + 60)).empty());
  // Beyond that the two wedges of metal share a triangle on the crown. A quarter of its base up, on
  // the one's surface, it is as far along the axis from the other's cut as from its surface.
  for (const double deep : {0.5, 3.0, 6.0}) {
    const auto all = found(k_joint(touching - deep));
    ASSERT_EQ(all.size(), 1U) << deep;
    EXPECT_EQ(all[0].a, 1U);
    EXPECT_EQ(all[0].b, 2U);
    EXPECT_NEAR(all[0].depth, deep / std::sqrt(8.0), 0.01) << deep;
    EXPECT_NEAR(all[0].at.z(), 109.55 + 0.25 * deep, 0.1);
  }
}

TEST(Overlap, OneThatIsCutMakesRoom) {
  auto spec = k_joint(-80);
  EXPECT_EQ(found(spec).size(), 1U);
  std::get<std::vector<Link>>(spec.connect)[1].to = {0, 1};
  EXPECT_TRUE(found(spec).empty());
}

TEST(Overlap, AMemberModelledTwiceIsReportedOnce) {
  NodeSpec spec{.members = {chord(), brace("B", 0, 1), brace("copy", 0, 1)},
                .connect = Within{20.0}};
  const auto all = found(spec);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_NEAR(all[0].depth, 5.0, 1e-6);  // the bore of the one in the other
  const auto said = warnings_of(spec, all);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].member, "members/1");  // the earlier of the two
  EXPECT_EQ(warnings_of(spec, all, 2).size(), 1U);
}

TEST(Overlap, AThirdMemberIsReportedForEachPair) {
  NodeSpec spec{.members = {brace("A", 0, 1), tube("B", {400, 0, -500}, {400, 0, 1500}, 88.9, 5),
                            tube("D", {-500, 0, 900}, {1500, 0, 900}, 60.3, 4)},
                .connect = Within{1.0}};
  const auto all = found(spec);
  ASSERT_EQ(all.size(), 3U);
  for (const auto& one : all) EXPECT_GT(one.depth, 20.0);
}

// Two tubes that cross: the metal of one reaches to the other's axis if it is the thinner one, and
// less as they move away from each other.
TEST(Overlap, CrossingTubesAreAsDeepAsTheyPass) {
  for (const double apart : {0.0, 20.0, 50.0, 60.0}) {
    NodeSpec spec{.members = {tube("A", {-800, 0, 0}, {800, 0, 0}, 76.1, 4),
                              tube("B", {0, apart, -800}, {0, apart, 800}, 48.3, 3.2)},
                  .connect = Within{0.0}};
    const auto all = found(spec);
    if (apart >= 62.2) {
      EXPECT_TRUE(all.empty());
      continue;
    }
    ASSERT_EQ(all.size(), 1U) << apart;
    const double want = std::min(38.05, 38.05 + 24.15 - apart);
    EXPECT_NEAR(all[0].depth, want, 0.05) << apart;
  }
}

// A tube in another's bore, and two laid end to end, share nothing.
TEST(Overlap, ASleeveAndAButtShareNothing) {
  NodeSpec sleeve{.members = {tube("A", {0, 0, 0}, {900, 0, 0}, 60.3, 3.2),
                              tube("B", {500, 0, 0}, {1500, 0, 0}, 53.9, 3)},
                  .connect = Within{0.0}};
  EXPECT_TRUE(found(sleeve).empty());
  sleeve.members[1] = tube("B", {900, 0, 0}, {1500, 0, 0}, 60.3, 3.2);
  EXPECT_TRUE(found(sleeve).empty());
  sleeve.members[1] = tube("B", {500, 0, 0}, {1500, 0, 0}, 56.9, 3);  // 1.5 mm into the wall
  const auto all = found(sleeve);
  ASSERT_EQ(all.size(), 1U);
}

// Random pairs against random points in the metal of both: no overlap is missed, and no point is
// deeper than reported.
TEST(Overlap, RandomPairsAgainstThrownPoints) {
  std::mt19937_64 engine(20261122);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  int shared = 0, apart = 0;
  for (int round = 0; round < 60; ++round) {
    const auto point = [&](double size) {
      return Vector3d(any(-size, size), any(-size, size), any(-size, size));
    };
    NodeSpec spec{.members = {tube("A", point(300), point(300), any(20, 160), 3),
                              tube("B", point(300), point(300), any(20, 160), 3)},
                  .connect = std::vector<Link>{}};
    for (auto& m : spec.members) m.wall = m.outer_radius * any(0.1, 0.5);
    const auto all = found(spec);
    const auto inside = [&](const Vector3d& p, const Member& m, bool metal) {
      const Vector3d along = m.finish - m.start;
      const double z = (p - m.start).dot(along) / along.norm();
      const double rho = (p - m.start).cross(along).norm() / along.norm();
      if (metal && rho < m.outer_radius - m.wall) return -1.0;
      return std::min({m.outer_radius - rho, z, along.norm() - z});
    };
    double deepest = 0.0;
    bool both = false;
    for (int k = 0; k < 40'000; ++k)
      for (const auto& [in, other] : {std::pair{0U, 1U}, std::pair{1U, 0U}}) {
        const auto& m = spec.members[in];
        const Vector3d along = m.finish - m.start;
        const Vector3d side = along.cross(point(1)).normalized();
        const Vector3d p =
            m.start + any(0, 1) * along + any(m.outer_radius - m.wall, m.outer_radius) * side;
        deepest = std::max(deepest, inside(p, spec.members[other], false));
        both = both || inside(p, spec.members[other], true) > 0.0;
      }
    if (both && deepest > 0.1) {
      ASSERT_EQ(all.size(), 1U) << round << ' ' << deepest;
      EXPECT_GT(all[0].depth, deepest - 0.05) << round;
      EXPECT_LT(all[0].depth, deepest + 0.1 * spec.members[0].outer_radius + 2.0) << round;
      ++shared;
    } else if (!both) {
      ++apart;
    }
    for (const auto& one : all) {
      EXPECT_GT(
          std::min(inside(one.at, spec.members[0], false), inside(one.at, spec.members[1], false)),
          -1e-6)
          << round;
    }
  }
  std::printf("%d share metal, %d are apart\n", shared, apart);
  EXPECT_GT(shared, 10);
  EXPECT_GT(apart, 10);
}

/// Members that all run through one point, and join nowhere.
NodeSpec crossed(std::size_t count) {
  NodeSpec spec{.members = {}, .connect = Within{0.0}};
  for (std::size_t i = 0; i < count; ++i) {
    const auto y = 100.0 * static_cast<double>(i);  // separated ends, so that no member joins
                                                    // another
    spec.members.push_back(tube("", {-1000, y, -1000}, {1000, -y, 1000}, 60.3, 4));
  }
  return spec;
}

void expect_one_too_many(std::size_t members, std::size_t most) {
  ASSERT_GT(members * (members - 1) / 2, most);
  const auto spec = crossed(members);
  const auto nodes = solve(spec);
  ASSERT_TRUE(nodes);
  const auto all = overlaps(spec, *nodes);
  ASSERT_FALSE(all);
  const auto& issue = all.error().issues.front();
  EXPECT_EQ(issue.code, ErrorCode::wrong_count);
  EXPECT_EQ(issue.member, "members");
  EXPECT_EQ(std::get<double>(issue.limit), static_cast<double>(most));
  EXPECT_EQ(std::get<double>(issue.got), static_cast<double>(most) + 1.0);
}

TEST(Overlap, ReportsAtMostTheLimitOfPairs) {
  expect_one_too_many(101, kMostOverlaps);
  EXPECT_EQ(found(crossed(20)).size(), 190U);
}

// Counted before any is looked at: these would share metal 5 000 times first.
TEST(Overlap, LooksAtNoMorePairsThanItMay) { expect_one_too_many(1415, kMostNearPairs); }

TEST(Overlap, StopsOnRequest) {
  const auto spec = k_joint(0);
  const auto nodes = solve(spec);
  const CancelledScope cancelled;
  EXPECT_EQ(overlaps(spec, *nodes, {}).error().code(), ErrorCode::cancelled);
}

}  // namespace
}  // namespace tubecut::joint
