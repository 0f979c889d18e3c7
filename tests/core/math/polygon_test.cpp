#include "core/math/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace tubecut::math {
namespace {

Polygon round_one(double x, double y, double radius, int corners = 720) {
  Polygon out;
  for (int i = 0; i < corners; ++i) {
    const double turn = 2 * std::numbers::pi * (i + 0.37) / corners;
    out.x.push_back(x + radius * std::cos(turn));
    out.y.push_back(y + radius * std::sin(turn));
  }
  return out;
}

Polygon box(double x, double y, double width, double height) {
  return {{x, x + width, x + width, x}, {y, y, y + height, y + height}};
}

Polygon swapped(Polygon p) {
  std::swap(p.x, p.y);
  return p;
}

TEST(Polygon, TwoCirclesShareALens) {
  const double r = 2, d = 1.7;
  const double lens = 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
  const std::vector<Polygon> both{round_one(0, 0, r), round_one(d * 0.6, d * 0.8, r)};
  EXPECT_NEAR(union_area(both), 2 * std::numbers::pi * r * r - lens, 2e-4 * lens);
  EXPECT_NEAR(union_area(std::vector{both[0]}), area(both[0]), 1e-12);
}

TEST(Polygon, BoxesByTheirCornersGrid) {
  std::mt19937_64 draw(7);
  std::uniform_int_distribution<int> place(0, 12), size(1, 6), count(1, 9);
  for (int run = 0; run < 300; ++run) {
    std::vector<Polygon> boxes, across;
    bool cell[20][20]{};
    for (int k = count(draw); k > 0; --k) {
      const int x = place(draw), y = place(draw), w = size(draw), h = size(draw);
      boxes.push_back(box(x, y, w, h));
      across.push_back(swapped(boxes.back()));
      for (int i = x; i < x + w; ++i)
        for (int j = y; j < y + h; ++j) cell[i][j] = true;
    }
    double whole = 0, inside = 0;
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) {
        whole += cell[i][j] ? 1 : 0;
        inside += cell[i][j] && i >= 3 && i < 9 && j >= 4 && j < 11 ? 1 : 0;
      }
    EXPECT_DOUBLE_EQ(union_area(boxes), whole);
    EXPECT_DOUBLE_EQ(union_area(across), whole);
    EXPECT_DOUBLE_EQ(union_area(boxes, {3, 9, 4, 11}), inside);
  }
}

// Stars that cross in many places: the same area by strips of either direction, turned, and moved.
TEST(Polygon, NeitherTurningNorDirectionChangesIt) {
  std::mt19937_64 draw(11);
  std::uniform_real_distribution<double> u(0, 1);
  for (int run = 0; run < 50; ++run) {
    std::vector<Polygon> stars, turned, other;
    const double angle = 6 * u(draw);
    for (int k = 0; k < 4; ++k) {
      Polygon star, moved;
      const double x = 3 * u(draw), y = 3 * u(draw);
      for (int i = 0; i < 24; ++i) {
        const double at = i * std::numbers::pi / 12, r = 0.5 + 2 * u(draw);
        star.x.push_back(x + r * std::cos(at));
        star.y.push_back(y + r * std::sin(at));
        moved.x.push_back(5 + std::cos(angle) * star.x.back() - std::sin(angle) * star.y.back());
        moved.y.push_back(-9 + std::sin(angle) * star.x.back() + std::cos(angle) * star.y.back());
      }
      other.push_back(swapped(star));
      stars.push_back(std::move(star));
      turned.push_back(std::move(moved));
    }
    const double whole = union_area(stars);
    double sum = 0;
    for (const auto& star : stars) {
      EXPECT_NEAR(union_area(std::vector{star}), area(star), 1e-12);
      EXPECT_LE(area(star), whole * (1 + 1e-12));
      sum += area(star);
    }
    EXPECT_LE(whole, sum * (1 + 1e-12));
    EXPECT_NEAR(union_area(other) / whole, 1.0, 1e-12);
    EXPECT_NEAR(union_area(turned) / whole, 1.0, 1e-12);
    const double left = union_area(stars, {.x_to = 1.3}),
                 right = union_area(stars, {.x_from = 1.3});
    EXPECT_NEAR((left + right) / whole, 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace tubecut::math
