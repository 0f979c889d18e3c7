#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "core/joint/finished.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int one_of(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  Vector3d direction() {
    std::normal_distribution<double> n;
    return Vector3d(n(engine_), n(engine_), n(engine_)).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

Member tube(const Vector3d& start, const Vector3d& finish, double radius, double wall) {
  return {.start = start, .finish = finish, .outer_radius = radius, .wall = wall};
}
/// Walls of 2 to 4 % of the diameter.
Member thin(Draw& draw, const Vector3d& start, const Vector3d& finish, double radius) {
  return tube(start, finish, radius, std::max(0.5, draw.any(0.04, 0.08) * radius));
}

struct Found {
  std::optional<Vector3d> at;
  std::size_t told = 0;
  double depth = 0.0;
};
Found find(const NodeSpec& spec, std::size_t a, std::size_t b) {
  const auto nodes = solve(spec);
  EXPECT_TRUE(nodes);
  const auto all = overlaps(spec, *nodes);
  EXPECT_TRUE(all);
  Found out{detail::shared_metal(detail::finished(spec, *nodes, a, {}),
                                 detail::finished(spec, *nodes, b, {}))};
  for (const auto& one : *all)
    if (one.a == a && one.b == b) {
      ++out.told;
      out.depth = one.depth;
    }
  return out;
}

/// How deep a point lies in the wall between square ends, by cross products.
double in_metal(const Member& m, const Vector3d& p) {
  const Vector3d along = (m.finish - m.start).normalized();
  const double z = (p - m.start).dot(along), rho = (p - m.start).cross(along).norm();
  return std::min(
      {m.outer_radius - rho, rho - (m.outer_radius - m.wall), z, (m.finish - m.start).norm() - z});
}

struct Between {
  double low, high;
};

/// Part of a convex polygon where normal . p >= from.
std::vector<Vector2d> clipped(const std::vector<Vector2d>& p, const Vector2d& normal, double from) {
  std::vector<Vector2d> out;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto &a = p[i], &b = p[(i + 1) % p.size()];
    const double at_a = normal.dot(a) - from, at_b = normal.dot(b) - from;
    if (at_a >= 0.0) out.push_back(a);
    if ((at_a >= 0.0) != (at_b >= 0.0)) out.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return out;
}

/// Distances from the axis' plane that the wall has at x from it, on one side.
Between half_chord(double inner, double outer, double x) {
  return {std::sqrt(std::max(0.0, inner * inner - x * x)),
          std::sqrt(std::max(0.0, outer * outer - x * x))};
}

/// Returns whether two walls whose axes cross share metal, each grown by `by`. On the planes across
/// the common perpendicular both walls are strips along their axes, so their intersections are
/// parallelograms, cut by the ends.
bool crossing_share(const Member& one, const Member& two, double by) {
  const Vector3d a = (one.finish - one.start).normalized();
  const Vector3d b = (two.finish - two.start).normalized();
  const Vector3d n = a.cross(b).normalized();
  const double sine = a.cross(b).norm(), cosine = a.dot(b);
  const Vector3d between = two.start - one.start;
  const double apart = between.dot(n);
  // The foot of the perpendicular on each axis.
  const double foot_a = between.cross(b).dot(n) / sine, foot_b = between.cross(a).dot(n) / sine;
  const Between on_a{-foot_a - by, (one.finish - one.start).norm() - foot_a + by};
  const Between on_b{-foot_b - by, (two.finish - two.start).norm() - foot_b + by};
  const double ra = one.outer_radius + by, rb = two.outer_radius + by;
  const double ia = std::max(0.0, one.outer_radius - one.wall - by);
  const double ib = std::max(0.0, two.outer_radius - two.wall - by);
  constexpr int kSteps = 1500;
  const double from = std::max(-ra, apart - rb), to = std::min(ra, apart + rb);
  if (!(from < to)) return false;
  for (int k = 0; k < kSteps; ++k) {
    const double x = from + (to - from) * (k + 0.5) / kSteps;
    const auto u = half_chord(ia, ra, x), v = half_chord(ib, rb, x - apart);
    for (const double su : {1.0, -1.0})
      for (const double sv : {1.0, -1.0}) {
        std::vector<Vector2d> p{{su * u.low, sv * v.low},
                                {su * u.high, sv * v.low},
                                {su * u.high, sv * v.high},
                                {su * u.low, sv * v.high}};
        const Vector2d along_a(cosine / sine, -1.0 / sine), along_b(1.0 / sine, -cosine / sine);
        p = clipped(p, along_a, on_a.low);
        p = clipped(p, -along_a, -on_a.high);
        p = clipped(p, along_b, on_b.low);
        p = clipped(p, -along_b, -on_b.high);
        if (!p.empty()) return true;
      }
  }
  return false;
}

/// The same of two that are parallel: rings in one plane.
bool parallel_share(const Member& one, const Member& two, double by) {
  const Vector3d a = (one.finish - one.start).normalized();
  const double apart = (two.start - one.start).cross(a).norm();
  const double s = (two.start - one.start).dot(a), t = (two.finish - one.start).dot(a);
  if (std::max(0.0, std::min(s, t)) - by >
      std::min((one.finish - one.start).norm(), std::max(s, t)) + by)
    return false;
  const auto inner = [&](const Member& m) { return m.outer_radius - m.wall - by; };
  const auto outer = [&](const Member& m) { return m.outer_radius + by; };
  return apart < outer(one) + outer(two) && apart + outer(one) > inner(two) &&
         apart + outer(two) > inner(one);
}

bool share(const Member& one, const Member& two, double by) {
  const Vector3d a = (one.finish - one.start).normalized();
  const Vector3d b = (two.finish - two.start).normalized();
  return a.cross(b).norm() < 1e-9 ? parallel_share(one, two, by) : crossing_share(one, two, by);
}

struct Pair {
  Member one, two;
};

/// Parallel next to each other, or one round the other.
Pair beside(Draw& draw) {
  const double r = draw.any(10, 100), s = draw.any(0.2, 1.0) * r;
  const Vector3d along = draw.direction(), across = along.unitOrthogonal();
  const double apart = draw.one_of(2) == 0 ? draw.any(0.8, 1.15) * (r + s) : draw.any(0.0, 1.1) * r;
  const Vector3d from = apart * across + draw.any(-600, 500) * along;
  const double side = draw.one_of(2) == 0 ? 1.0 : -1.0;
  return {thin(draw, Vector3d::Zero(), 500 * along, r),
          thin(draw, from, from + side * draw.any(50, 800) * along, s)};
}

/// Crossing anywhere, at any angle, in part beyond each other's ends.
Pair crossed(Draw& draw) {
  const double r = draw.any(10, 100), s = draw.any(0.2, 1.0) * r;
  const Vector3d along = draw.direction(), to = draw.direction();
  const Vector3d common = along.cross(to).normalized();
  const Vector3d middle = draw.any(-1.15, 1.15) * (r + s) * common + draw.any(-250, 250) * along;
  const Vector3d start = middle + draw.any(-1.0, 0.5) * 200 * to;
  return {thin(draw, -200 * along, 200 * along, r),
          thin(draw, start, start + draw.any(60, 400) * to, s)};
}

/// A bar through a tube, or one that leans in its bore and ends in it.
Pair bar(Draw& draw) {
  const double r = draw.any(40, 150), s = draw.any(0.05, 0.4) * r;
  const Vector3d along = draw.direction(), side = along.unitOrthogonal();
  const bool within = draw.one_of(2) == 0;
  const double lean = within ? draw.any(0.0, 0.15) : draw.any(0.3, 1.57);
  const Vector3d to = std::cos(lean) * along + std::sin(lean) * side;
  const Vector3d off = draw.any(-0.9, 0.9) * r * along.cross(side);
  const double half = within ? draw.any(0.5, 4.0) * r : 4.0 * r / std::sin(lean);
  return {thin(draw, -800 * along, 800 * along, r),
          thin(draw, off - half * to, off + half * to, s)};
}

/// Nearly touching: outside along each other, end to end, and round each other.
Pair touching(Draw& draw) {
  const double r = draw.any(20, 80);
  const Vector3d along = draw.direction(), across = along.unitOrthogonal();
  const double gap = draw.any(0.03, 0.2) * (draw.one_of(2) == 0 ? 1.0 : -1.0);
  auto one = thin(draw, Vector3d::Zero(), 400 * along, r);
  if (draw.one_of(3) == 0) {
    const Vector3d from = (r + 0.5 * r + gap) * across + draw.any(-50, 50) * along;
    return {one, thin(draw, from, from + 300 * along, 0.5 * r)};
  }
  if (draw.one_of(2) == 0) {
    const Vector3d from = (400 + gap) * along;
    return {one, thin(draw, from, from + 300 * along, r)};
  }
  return {one, thin(draw, 50 * along, 350 * along, r - one.wall - gap)};
}

struct Counts {
  int shared = 0, clear = 0, between = 0;
};

void hold(const Pair& pair, int round, Counts& counts) {
  constexpr double kBand = 0.02;  // mm: nearer to touching either answer is right
  const NodeSpec spec{.members = {pair.one, pair.two}, .connect = std::vector<Link>{}};
  const auto found = find(spec, 0, 1);
  EXPECT_EQ(found.told, found.at ? 1U : 0U) << round;
  if (found.at) {
    EXPECT_GE(in_metal(pair.one, *found.at), -1e-6) << round;
    EXPECT_GE(in_metal(pair.two, *found.at), -1e-6) << round;
    EXPECT_GT(found.depth, 0.004) << round;
  }
  if (share(pair.one, pair.two, -kBand)) {
    EXPECT_TRUE(found.at.has_value()) << round;
    ++counts.shared;
  } else if (!share(pair.one, pair.two, kBand)) {
    EXPECT_FALSE(found.at.has_value()) << round;
    ++counts.clear;
  } else {
    ++counts.between;
  }
}

void hold_many(Pair (*draw_pair)(Draw&), std::uint64_t seed, int rounds) {
  Draw draw(seed);
  Counts counts;
  for (int round = 0; round < rounds; ++round) hold(draw_pair(draw), round, counts);
  std::printf("%d share metal, %d are clear, %d nearly touch\n", counts.shared, counts.clear,
              counts.between);
  EXPECT_GT(counts.shared, rounds / 5);
  EXPECT_GT(counts.clear, rounds / 8);
}

TEST(SharedMetal, ParallelTubes) { hold_many(beside, 1, 200); }
TEST(SharedMetal, CrossingAtAnyAngle) { hold_many(crossed, 2, 200); }
TEST(SharedMetal, BarsThroughAndInTubes) { hold_many(bar, 3, 150); }
TEST(SharedMetal, NearlyTouching) { hold_many(touching, 4, 150); }

// Two braces on one chord, each cut only by the chord: points of one wall near the chord, compared
// with the other's.
TEST(SharedMetal, BracesOnOneChord) {
  Draw draw(5);
  int shared = 0, clear = 0;
  for (int round = 0; round < 80; ++round) {
    const double radius = draw.any(60, 150);
    const auto brace = [&](double lean, double x, double turn) {
      const double r = draw.any(0.2, 0.45) * radius;
      const Vector3d to(std::cos(lean), std::sin(lean) * std::sin(turn),
                        std::sin(lean) * std::cos(turn));
      return thin(draw, {x, 0, 0}, Vector3d(x, 0, 0) + 900 * to, r);
    };
    const double apart = draw.any(-0.5, 0.9) * radius;
    const NodeSpec spec{
        .members = {tube({-2000, 0, 0}, {2000, 0, 0}, radius, 0.05 * radius),
                    brace(std::numbers::pi - draw.any(0.6, 1.5), -0.5 * apart, draw.any(-0.4, 0.4)),
                    brace(draw.any(0.6, 1.5), 0.5 * apart, draw.any(-0.4, 0.4))},
        .connect = std::vector<Link>{{1, End::start, {0}}, {2, End::start, {0}}}};
    const auto found = find(spec, 1, 2);
    const auto kept = [&](std::size_t i, const Vector3d& p) {
      const auto& m = spec.members[i];
      const Vector3d along = (m.finish - m.start).normalized();
      const double z = (p - m.start).dot(along), rho = (p - m.start).cross(along).norm();
      const double out = std::hypot(p.y(), p.z()) - radius;
      // The scrap lies behind the chord.
      return std::min(
          {m.outer_radius - rho, rho - (m.outer_radius - m.wall), 900 - z, z < 0.0 ? -1.0 : out});
    };
    if (found.at) {
      EXPECT_GE(kept(1, *found.at), -1e-6) << round;
      EXPECT_GE(kept(2, *found.at), -1e-6) << round;
    }
    double deepest = -1e9;
    for (const auto& [in, other] : {std::pair{1U, 2U}, std::pair{2U, 1U}}) {
      const auto& m = spec.members[in];
      const Vector3d along = (m.finish - m.start).normalized(), x = along.unitOrthogonal();
      for (int i = 0; i < 180; ++i) {
        const Vector3d q = Eigen::AngleAxisd(i * std::numbers::pi / 90, along) * x;
        for (const double share : {0.02, 0.5, 0.98})
          for (int k = 0; k < 100; ++k) {
            const Vector3d p =
                m.start + (m.outer_radius - share * m.wall) * q + (2.0 + 600.0 * k / 100) * along;
            deepest = std::max(deepest, std::min(kept(in, p), kept(other, p)));
          }
      }
    }
    if (deepest > 0.02) {
      EXPECT_TRUE(found.at.has_value()) << round << ' ' << deepest;
      ++shared;
    }
    clear += found.at ? 0 : 1;
  }
  std::printf("%d share metal, %d are clear\n", shared, clear);
  EXPECT_GT(shared, 8);
  EXPECT_GT(clear, 15);
}

}  // namespace
}  // namespace tubecut::joint
