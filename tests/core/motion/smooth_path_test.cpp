// The smoothed path keeps its tolerance everywhere, not only at its knots.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/motion/path/path.hpp"

namespace tubecut::motion {
namespace {

using Point = std::array<double, 2>;

double distance(const Point& p, const Point& a, const Point& b) {
  const Point way{b[0] - a[0], b[1] - a[1]};
  const double share = std::clamp(((p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1]) /
                                      std::hypot(way[0], way[1]) / std::hypot(way[0], way[1]),
                                  0.0, 1.0);
  return std::hypot(a[0] + share * way[0] - p[0], a[1] + share * way[1] - p[1]);
}

/// A stroke with corners by up to 170 deg, as of a letter, or a wavy line with many points.
Program stroke(std::mt19937& random, bool sharp) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Program out{.coordinates = {{}, {}, {.weight = kBevelWeight, .group = Coordinate::Group::bevel}},
              .x = {{}, {}, {}}};
  double x = 0.0, y = 0.0, way = 0.0;
  const int points = sharp ? 4 : 60;
  for (int i = 0; i < points; ++i) {
    out.x[0].push_back(x);
    out.x[1].push_back(y);
    out.x[2].push_back(0.0);
    way += (sharp ? 170.0 : 19.0) * kRadPerDeg * (2.0 * share(random) - 1.0);
    const double step = sharp ? 0.3 + 3.0 * share(random) : 0.05 + 0.5 * share(random);
    x += step * std::cos(way);
    y += step * std::sin(way);
  }
  out.corner = std::vector<bool>(out.size(), sharp);
  return out;
}

/// Returns the largest distance of the curve to the polyline, at 20 points between two knots.
double farthest(const Path& path, const Program& program) {
  double out = 0.0;
  for (std::size_t i = 0; i < path.intervals(); ++i) {
    for (int j = 0; j < 20; ++j) {
      const auto at = path.at(i, path.d * j / 20.0);
      double nearest = 1e300;
      for (std::size_t k = 0; k + 1 < program.size(); ++k)
        nearest = std::min(nearest, distance({at[0], at[1]}, {program.x[0][k], program.x[1][k]},
                                             {program.x[0][k + 1], program.x[1][k + 1]}));
      out = std::max(out, nearest);
    }
  }
  return out;
}

TEST(SmoothPath, KeepsItsToleranceBetweenKnots) {
  std::mt19937 random(20);
  for (const bool sharp : {true, false})
    for (const double eps : {0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002})
      for (int drawn = 0; drawn < 25; ++drawn) {
        const auto program = stroke(random, sharp);
        const auto path = smooth_path(program, eps, Angle::deg(0.5));
        ASSERT_TRUE(path);
        EXPECT_LE(farthest(*path, program), eps + path->sag_tip + path->d / 1400.0)
            << (sharp ? "sharp " : "wavy ") << eps << " " << drawn << " knots " << path->d;
      }
}

}  // namespace
}  // namespace tubecut::motion
