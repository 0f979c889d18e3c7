#include "core/joint/node/node.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "core/joint/contour.hpp"
#include "core/joint/nearness.hpp"
#include "tests/core/joint/published.hpp"
#include "tests/support/cancelled.hpp"
#include "tests/support/ray_caster.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) { std::cout << "seed " << seed << '\n'; }
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vector3d in_box(double half) { return {any(-half, half), any(-half, half), any(-half, half)}; }
  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(any(-1, 1), any(-1, 1), any(-1, 1), any(-1, 1))
        .normalized()
        .toRotationMatrix();
  }

 private:
  std::mt19937_64 engine_;
};

/// A chord and a brace that starts near it, cut at its start.
NodeSpec pair(Random& random, double size) {
  NodeSpec out;
  out.members.resize(2);
  out.members[0] = {.start = random.in_box(size),
                    .finish = random.in_box(size),
                    .outer_radius = random.any(60, 200),
                    .wall = 5};
  out.members[1] = {.start = random.in_box(size),
                    .finish = random.in_box(size),
                    .outer_radius = random.any(20, 55),
                    .wall = 4};
  if (random.any(0, 1) < 0.5) out.members[1].up = random.in_box(1.0);
  out.connect = std::vector<Link>{{.member = 1, .end = End::start, .to = {0}}};
  return out;
}

/// Distance of a world point to the cutter's axis, from the four numbers, in long double.
long double off_axis(const MemberFrame& frame, const TubeCutter& tube, const Vector3d& world) {
  const auto body =
      ray::tube(0, tube.inclination.rad(), tube.clocking.rad(), tube.offset, tube.height);
  ray::Point p{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      p[static_cast<std::size_t>(r)] += static_cast<long double>(frame.rows(r, c)) *
                                        (static_cast<long double>(world[c]) - frame.origin[c]);
  const ray::Body axis{1, body.point, body.direction};
  return std::sqrt(std::max(0.0L, ray::outside(axis, p) + 1));
}

TEST(Node, WorldToParametersToWorld) {
  Random random(20260120);
  long double worst = 0;
  int members = 0;
  while (members < 10000) {
    const auto spec = pair(random, std::pow(10.0, random.any(2, 5)));
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes);
    const auto& end = nodes->ends[2];
    if (end.cut_by.empty()) {  // nearly parallel: the cut would reach beyond the brace's other end
      ASSERT_FALSE(nodes->warnings.empty());
      ASSERT_EQ(nodes->warnings[0].code, WarningCode::parallel_members);
      continue;
    }
    ASSERT_EQ(end.cut_by.size(), 1U);
    if (end.cut_by[0].plane) continue;  // in line by chance
    const auto& tube = end.cut_by[0].placement.tube;
    const auto& chord = spec.members[0];
    const double scale = (chord.start - end.frame.origin).norm() +
                         (chord.finish - end.frame.origin).norm() + std::abs(tube.height);
    for (const auto& at : {chord.start, chord.finish})
      worst = std::max(worst, off_axis(end.frame, tube, at) / scale);
    ++members;
  }
  std::cout << "worst " << worst << " of the lengths\n";
  EXPECT_LT(worst, 1e-12L);
}

TEST(Node, GoldenNodeGivesItsParameters) {
  const auto golden = testing::golden(kGolden);
  const auto vector = [&](const std::string& path) {
    const auto v = testing::numbers(golden, "node/" + path);
    return Vector3d(v.at(0), v.at(1), v.at(2));
  };
  NodeSpec spec;
  for (const std::string m : {"members/0", "members/1"})
    spec.members.push_back({.start = vector(m + "/A"),
                            .finish = vector(m + "/B"),
                            .outer_radius = testing::number(golden, "node/" + m + "/r"),
                            .wall = 5});
  spec.members.push_back({.start = vector("p_cut"),
                          .finish = vector("p_far"),
                          .outer_radius = 50,
                          .wall = 5,
                          .priority = 1,
                          .up = vector("phase_ref")});
  spec.connect = std::vector<Link>{{.member = 2, .end = End::start, .to = {1, 0}}};
  const auto nodes = solve(spec);
  ASSERT_TRUE(nodes);
  const auto& end = nodes->ends[4];
  ASSERT_EQ(end.cut_by.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string want = "node/cutters/" + std::to_string(i);
    const auto& got = end.cut_by[i].placement.tube;
    EXPECT_NEAR(got.inclination.deg(), testing::number(golden, want + "/alpha"), 1e-11);
    EXPECT_NEAR(got.clocking.deg(), testing::number(golden, want + "/beta"), 1e-11);
    EXPECT_NEAR(got.offset, testing::number(golden, want + "/s"), 1e-10);
    EXPECT_NEAR(got.height, testing::number(golden, want + "/h"), 1e-10);
  }
  EXPECT_NEAR(end.cut_by[1].placement.point_axial, testing::number(golden, "node/cutters/1/wmin"),
              1e-10);
  EXPECT_FALSE(end.cut_by[0].ghost);
}

void expect_same(const MemberEnd& a, const MemberEnd& b, double length) {
  ASSERT_EQ(a.cut_by.size(), b.cut_by.size());
  for (std::size_t i = 0; i < a.cut_by.size(); ++i) {
    const auto& p = a.cut_by[i].placement.tube;
    const auto& q = b.cut_by[i].placement.tube;
    const double sine = std::sin(p.inclination.rad());
    EXPECT_EQ(a.cut_by[i].member, b.cut_by[i].member);
    EXPECT_EQ(a.cut_by[i].plane.has_value(), b.cut_by[i].plane.has_value());
    if (a.cut_by[i].plane) continue;  // in line: it has no placement
    EXPECT_NEAR(p.inclination.rad(), q.inclination.rad(), 1e-12);
    EXPECT_NEAR(std::remainder(p.clocking.rad() - q.clocking.rad(), kTwoPi), 0.0, 1e-11 / sine);
    EXPECT_NEAR(p.offset, q.offset, 1e-11 * length / sine);
    EXPECT_NEAR(p.height, q.height, 1e-11 * length / sine / sine);
    EXPECT_NEAR(a.cut_by[i].gap, b.cut_by[i].gap, 1e-11 * length);
  }
  EXPECT_EQ(a.open, b.open);
}

/// A node of `count` members round the origin, each joined within a distance; the first passes.
NodeSpec star(Random& random, std::size_t count) {
  NodeSpec out;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d way = random.in_box(1.0).normalized() * random.any(800, 2000);
    const Vector3d near = random.in_box(10.0);
    out.members.push_back({.start = i == 0 ? Vector3d(near - way) : near,
                           .finish = near + way,
                           .outer_radius = i == 0 ? 120.0 : random.any(30, 60),
                           .wall = 4});
  }
  out.connect = Within{40.0};
  return out;
}

TEST(Node, TurningTheWorldMovesNothing) {
  Random random(20260121);
  int cut = 0;
  for (int n = 0; n < 200; ++n) {
    const auto spec = star(random, 5);
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes);
    auto turned = spec;
    const auto rotation = random.rotation();
    const Vector3d shift = random.in_box(500.0);
    for (auto& m : turned.members) {
      m.start = rotation * m.start + shift;
      m.finish = rotation * m.finish + shift;
    }
    const auto again = solve(turned);
    ASSERT_TRUE(again);
    for (std::size_t i = 0; i < nodes->ends.size(); ++i) {
      expect_same(nodes->ends[i], again->ends[i], 4000.0);
      cut += nodes->ends[i].cut_by.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(cut, 700);
}

TEST(Node, TurningTheTargetAboutItsAxisMovesOnlyPhi) {
  Random random(20260122);
  for (int n = 0; n < 200; ++n) {
    auto spec = star(random, 4);
    auto& brace = spec.members[3];
    const Vector3d z = (brace.finish - brace.start).normalized();
    brace.up = z.unitOrthogonal();
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes);
    const double angle = random.any(-3, 3);
    brace.up = Eigen::AngleAxisd(angle, z) * *brace.up;
    const auto again = solve(spec);
    ASSERT_TRUE(again);
    auto want = nodes->ends[6];
    for (auto& by : want.cut_by)
      by.placement.tube.clocking = by.placement.tube.clocking - Angle::rad(angle);
    expect_same(want, again->ends[6], 4000.0);
  }
}

TEST(Node, ScalingByPowersOfTwoScalesBitForBit) {
  Random random(20260123);
  for (int n = 0; n < 100; ++n) {
    const auto spec = star(random, 5);
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes);
    for (const double k : {0.25, 4.0, 64.0}) {
      auto scaled = spec;
      for (auto& m : scaled.members) {
        m.start *= k;
        m.finish *= k;
        m.outer_radius *= k;
        m.wall *= k;
      }
      scaled.connect = Within{40.0 * k};
      const auto again = solve(scaled);
      ASSERT_TRUE(again);
      for (std::size_t i = 0; i < nodes->ends.size(); ++i) {
        const auto& a = nodes->ends[i].cut_by;
        const auto& b = again->ends[i].cut_by;
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t j = 0; j < a.size(); ++j) {
          EXPECT_EQ(a[j].placement.tube.inclination, b[j].placement.tube.inclination);
          EXPECT_EQ(a[j].placement.tube.clocking, b[j].placement.tube.clocking);
          EXPECT_EQ(k * a[j].placement.tube.offset, b[j].placement.tube.offset);
          EXPECT_EQ(k * a[j].placement.tube.height, b[j].placement.tube.height);
          EXPECT_EQ(k * a[j].gap, b[j].gap);
          EXPECT_EQ(a[j].ghost, b[j].ghost);
        }
      }
    }
  }
}

TEST(Node, TwoMembersNeverCutEachOther) {
  Random random(20260124);
  for (int n = 0; n < 200; ++n) {
    auto spec = star(random, 6);
    for (auto& m : spec.members) {
      m.priority = static_cast<int>(random.any(0, 3));
      m.outer_radius = 20.0 * std::floor(random.any(2, 5));
    }
    const auto nodes = solve(spec);
    if (!nodes) {
      EXPECT_EQ(nodes.error().code(), ErrorCode::ambiguous_connection);
      continue;
    }
    std::vector<std::vector<bool>> cuts(6, std::vector<bool>(6, false));
    for (const auto& end : nodes->ends)
      for (const auto& by : end.cut_by)
        if (!by.plane) cuts[by.member][end.member] = true;  // a plane cuts both
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) EXPECT_FALSE(cuts[i][j] && cuts[j][i]);
  }
}

// The grid against every pair.
TEST(Nearness, FindsEveryTouch) {
  Random random(20260125);
  std::size_t total = 0;
  for (int n = 0; n < 20; ++n) {
    std::vector<AxisSegment> all;
    for (int i = 0; i < 150; ++i) {
      const Vector3d start = random.in_box(3000);
      const double length = i % 10 == 0 ? 6000.0 : random.any(50, 900);
      all.push_back({start, start + random.in_box(1.0).normalized() * length,
                     i % 17 == 0 ? 700.0 : random.any(10, 150)});
    }
    const auto found = touches(all, 1000);
    ASSERT_TRUE(found);
    std::size_t at = 0;
    for (std::size_t end = 0; end < 300; ++end)
      for (std::size_t other = 0; other < 150; ++other) {
        const Vector3d p = end % 2 == 0 ? all[end / 2].start : all[end / 2].finish;
        if (other == end / 2 || nearness(p, all[other]).distance > all[other].reach) continue;
        ASSERT_LT(at, found->size());
        EXPECT_EQ((*found)[at].end, end);
        EXPECT_EQ((*found)[at].other, other);
        ++at;
      }
    EXPECT_EQ(at, found->size());
    total += at;
  }
  EXPECT_GT(total, 300U);
}

TEST(Nearness, ACrowdIsRefused) {
  NodeSpec spec;
  for (int i = 0; i < 70; ++i)
    spec.members.push_back({.start = Vector3d::Zero(),
                            .finish = Vector3d(std::cos(i), std::sin(i), 0.1 * i) * 900,
                            .outer_radius = 10,
                            .wall = 1});
  spec.connect = Within{5};
  const auto nodes = solve(spec);
  ASSERT_FALSE(nodes);
  EXPECT_EQ(nodes.error().code(), ErrorCode::wrong_count);
  const CancelledScope cancelled;
  EXPECT_EQ(solve(spec).error().code(), ErrorCode::cancelled);
}

double value(const std::vector<Check>& checks, const std::string& name) {
  for (const auto& check : checks)
    if (check.name == name) return check.value / std::max(check.limit, 1e-300);
  return -1.0;
}

// Each check sees ten times its limit in one number of a good answer.
TEST(Node, EveryCheckSeesACorruptedNumber) {
  Random random(20260126);
  const auto spec = star(random, 4);
  const auto good = solve(spec);
  ASSERT_TRUE(good);
  const auto checks = verify(spec, *good);
  ASSERT_EQ(checks.size(), 6U);
  for (const auto& check : checks) EXPECT_TRUE(check.passed()) << check.name << check.value;
  const auto corrupt = [&](const std::string& name, auto change) {
    auto bad = *good;
    auto& end = bad.ends[6];
    ASSERT_FALSE(end.cut_by.empty());
    change(end, end.cut_by[0]);
    EXPECT_GT(value(verify(spec, bad), name), 1.0) << name;
  };
  const double length = 1e-11 * 8000.0;
  corrupt("axis_in_world", [&](MemberEnd&, CutBy& by) { by.placement.tube.offset += length; });
  corrupt("axis_in_world", [&](MemberEnd&, CutBy& by) { by.placement.tube.height += 9 * length; });
  corrupt("axis_in_world", [&](MemberEnd&, CutBy& by) {
    by.placement.tube.clocking = by.placement.tube.clocking + Angle::rad(1e-10);
  });
  corrupt("inclination", [&](MemberEnd&, CutBy& by) {
    by.placement.tube.inclination = by.placement.tube.inclination + Angle::deg(1e-8);
  });
  corrupt("eccentricity", [&](MemberEnd&, CutBy& by) { by.eccentricity += 9 * length; });
  corrupt("gap", [&](MemberEnd&, CutBy& by) { by.gap += length; });
  corrupt("frame", [&](MemberEnd& end, CutBy&) { end.frame.rows(0, 1) += 1e-11; });
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto fails = [&](auto change) {
    auto bad = *good;
    change(bad.ends[6], bad.ends[6].cut_by[0]);
    return !std::ranges::all_of(verify(spec, bad), &Check::passed);
  };
  EXPECT_TRUE(fails([&](MemberEnd&, CutBy& by) { by.placement.tube.offset = none; }));
  EXPECT_TRUE(fails([&](MemberEnd&, CutBy& by) { by.placement.tube.height = none; }));
  EXPECT_TRUE(fails([&](MemberEnd&, CutBy& by) { by.eccentricity = none; }));
  EXPECT_TRUE(fails([&](MemberEnd&, CutBy& by) { by.gap = none; }));
  EXPECT_TRUE(fails([&](MemberEnd& end, CutBy&) { end.frame.rows(0, 1) = none; }));
  auto mutual = *good;
  mutual.ends[0].cut_by.push_back({.member = 3});
  EXPECT_GT(value(verify(spec, mutual), "one_cuts_the_other"), 1.0);
}

}  // namespace
}  // namespace tubecut::joint
