// Boxes of chords give the same result as all chords together.
#include "core/motion/path/chords.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/motion/path/border.hpp"
#include "core/motion/path/stretch.hpp"

namespace tubecut::motion {
namespace {

double of(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

/// A walk that turns, rests and crosses itself.
std::vector<Flat> walk(std::mt19937& random, int points) {
  std::vector<Flat> out;
  Flat at{of(random, -50.0, 50.0), of(random, -50.0, 50.0)};
  double way = 0.0;
  for (int i = 0; i < points; ++i) {
    out.push_back(at);
    way += of(random, -0.5, 0.5);
    const double step = i % 7 == 3 ? 0.0 : of(random, 0.0, 3.0);
    at = {at.s + step * std::cos(way), at.z + step * std::sin(way)};
  }
  return out;
}

TEST(Chords, OfALineTheNearestIsTheNearestOfAll) {
  std::mt19937 random(1);
  for (const int points : {1, 2, 63, 64, 65, 128, 129, 130, 1000})
    for (int i = 0; i < 200; ++i) {
      const auto line = walk(random, points);
      const auto& near = line[static_cast<std::size_t>(i * 7919) % line.size()];
      const double far = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 5.0 : 200.0;
      const Flat p{near.s + of(random, -far, far), near.z + of(random, -far, far)};
      double all = distance(p, line.front(), line.front());
      for (std::size_t k = 1; k < line.size(); ++k)
        all = std::min(all, distance(p, line[k - 1], line[k]));
      EXPECT_EQ(nearer(1e300, p, Chords(line)), all) << points << " " << i;
      EXPECT_EQ(nearer(0.5 * all, p, Chords(line)), 0.5 * all);
    }
}

/// A wavy end of a tube, or a hole that is no circle, begun at one of its points.
CutPath closed(bool hole, int points, int first) {
  CutPath out{.outer_radius = 50.0, .wall = 6.0, .scrap = hole ? Scrap::inside : Scrap::minus_z};
  for (int i = 0; i < points + (hole ? 1 : 0); ++i) {
    const int at = first + i;
    const double t = kTwoPi * (at % points) / points;
    const double turn = hole ? 0.0 : kTwoPi * (at / points);
    const double r = 15.0 + 3.0 * std::cos(3.0 * t);
    out.phi.push_back(hole ? r * std::cos(t) / 50.0 : t + turn);
    out.z.push_back(hole ? r * std::sin(t) : 20.0 * std::cos(2.0 * t));
    out.b.push_back(0.3 + 0.2 * std::sin(t));
  }
  return out;
}

TEST(Chords, DepthsDoNotDependOnTheStart) {
  std::mt19937 random(2);
  for (const bool hole : {false, true}) {
    const auto made = part_border(closed(hole, 500, 0), -1.0);
    ASSERT_TRUE(made) << made.error().issues.front().member << made.error().issues.front().hint;
    const auto& border = *made;
    int inside = 0, outside = 0;
    for (const int first : {1, 63, 64, 250, 499}) {
      const auto turned = part_border(closed(hole, 500, first), -1.0);
      ASSERT_TRUE(turned) << first << turned.error().issues.front().member;
      for (int i = 0; i < 200; ++i) {
        const CutPoint p{.phi = hole ? of(random, -0.6, 0.6) : of(random, -4.0, 8.0),
                         .z = of(random, -30.0, 30.0),
                         .b = of(random, -0.6, 0.6)};
        const double depth = intrusion(border, p);
        EXPECT_NEAR(intrusion(*turned, p), depth, 1e-9) << hole << " " << first;
        ++(depth > 0.0 ? inside : outside);
      }
    }
    EXPECT_GT(std::min(inside, outside), 100);
  }
}

TEST(Chords, ASegmentsLengthIsTheDistanceOfItsEnds) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    Track whole{.radius = 40.0, .closed = true, .turns = 1};
    for (const auto& p : walk(random, 150)) whole.points.push_back({p.s / 40.0, p.z, 0.1});
    const auto length = lengths_along(whole);
    double from = of(random, 0.0, length.back()), to = of(random, 0.0, length.back());
    if (i % 4 == 1) from = length[50];
    if (i % 4 == 2) to = length[100];
    if (from > to) std::swap(from, to);
    const auto part = stretch_of(whole, length, from, to);
    EXPECT_NEAR(lengths_along(part).back(), to - from, 1e-9);
    for (const auto& [at, end] : {std::pair{from, part.points.front()}, {to, part.points.back()}}) {
      const auto there = at_length(whole, length, at);
      EXPECT_NEAR(there.phi, end.phi, 1e-12);
      EXPECT_NEAR(there.z, end.z, 1e-12);
    }
  }
}

}  // namespace
}  // namespace tubecut::motion
