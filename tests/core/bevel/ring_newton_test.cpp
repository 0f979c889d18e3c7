#include "core/bevel/smoothing/ring_newton.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tubecut::bevel {
namespace {

/// A quadratic over a closed path, node by node.
struct Quadratic {
  std::vector<double> h, height, slope, bend, of_f, of_v, of_u;
};

Quadratic random_quadratic(std::mt19937_64& random, std::size_t n, double decades) {
  std::uniform_real_distribution<double> exponent(-decades, decades);
  std::normal_distribution<double> normal;
  const auto weight = [&] { return std::pow(10.0, exponent(random)); };
  Quadratic out;
  for (std::size_t j = 0; j < n; ++j) {
    out.h.push_back(std::pow(10.0, 0.3 * exponent(random)));
    out.height.push_back(weight());
    out.slope.push_back(weight());
    out.bend.push_back(weight());
    for (auto* terms : {&out.of_f, &out.of_v, &out.of_u}) terms->push_back(normal(random));
  }
  return out;
}

struct Path {
  std::vector<double> f, v;
};

/// In packs each lane has an arc: n is a multiple of its lanes.
template <class Numbers>
Path least(const Quadratic& q) {
  const auto n = q.h.size(), arc = n / static_cast<std::size_t>(PackOf<Numbers>::kSize);
  const auto at = [&](const std::vector<double>& values, std::size_t j) {
    Numbers out{};
    for (int k = 0; k < PackOf<Numbers>::kSize; ++k)
      set_lane(out, k, values[static_cast<std::size_t>(k) * arc + j]);
    return out;
  };
  RingNewton<Numbers> newton(arc);
  for (std::size_t j = 0; j < arc; ++j) newton.length(j) = at(q.h, j);
  newton.factor([&](std::size_t j) {
    return typename RingNewton<Numbers>::Weights{at(q.height, j), at(q.slope, j), at(q.bend, j)};
  });
  Path out{std::vector<double>(n), std::vector<double>(n)};
  newton.solve(
      [&](std::size_t j) {
        return typename RingNewton<Numbers>::Terms{at(q.of_f, j), at(q.of_v, j), at(q.of_u, j)};
      },
      [&](std::size_t j, const Numbers& f, const Numbers& v, const Numbers&) {
        for (int k = 0; k < PackOf<Numbers>::kSize; ++k) {
          const auto node = static_cast<std::size_t>(k) * arc + j;
          out.f[node] = static_cast<double>(lane(f, k));
          out.v[node] = static_cast<double>(lane(v, k));
        }
      });
  return out;
}

double size(const std::vector<double>& values) {
  double out = 0.0;
  for (const double x : values) out = std::max(out, std::abs(x));
  return out;
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double out = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) out = std::max(out, std::abs(a[j] - b[j]));
  return out / size(b);
}

/// Slopes lead from each height to the next, round the ring, and the gradient vanishes: for a
/// single moved height, and for a slope with the rest closed again by the next.
TEST(RingNewton, IsStationaryOnAClosedPath) {
  std::mt19937_64 random(20261126);
  for (const std::size_t n : {8U, 16U, 40U, 360U}) {
    const auto q = random_quadratic(random, n, 1.0);
    const auto [f, v] = least<Pack>(q);
    std::vector<double> force(n), moment(n);
    const auto bend = [&](std::size_t j) {
      return q.bend[j] * (v[j] - v[(j + n - 1) % n]) + q.of_u[j];
    };
    for (std::size_t j = 0; j < n; ++j) {
      EXPECT_NEAR(f[(j + 1) % n], f[j] + q.h[j] * v[j], 1e-12 * (size(f) + size(v)))
          << n << ' ' << j;
      force[j] = q.height[j] * f[j] + q.of_f[j];
      moment[j] = q.slope[j] * v[j] + q.of_v[j] + bend(j) - bend((j + 1) % n);
    }
    // Height j up by 1 is a slope of 1/h before it and of -1/h after it.
    for (std::size_t j = 0; j < n; ++j) {
      const auto before = (j + n - 1) % n;
      const double up = moment[before] / q.h[before], down = moment[j] / q.h[j];
      EXPECT_NEAR(force[j] + up - down, 0.0, 1e-10 * (std::abs(up) + std::abs(down) + 1.0))
          << n << ' ' << j;
    }
  }
}

/// Eight arcs, one round, and one with more digits are the same path.
TEST(RingNewton, ArcsAreTheRing) {
  std::mt19937_64 random(20261127);
  for (const double decades : {0.0, 2.0, 6.0})
    for (int i = 0; i < 50; ++i) {
      const auto q = random_quadratic(random, 8 + 8 * static_cast<std::size_t>(i % 8), decades);
      const auto exact = least<long double>(q), ring = least<double>(q), arcs = least<Pack>(q);
      EXPECT_LE(apart(ring.f, exact.f), 1e-9) << decades << ' ' << i;
      EXPECT_LE(apart(arcs.f, exact.f), 1e-9) << decades << ' ' << i;
      EXPECT_LE(apart(arcs.v, exact.v), 1e-9) << decades << ' ' << i;
    }
}

}  // namespace
}  // namespace tubecut::bevel
