#include "core/joint/stations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/joint/length.hpp"
#include "core/joint/solid_arrays.hpp"
#include "tests/core/joint/published.hpp"
#include "tests/core/joint/random_nodes.hpp"

namespace tubecut::joint {
namespace {

/// Tubes in all positions, one of them in every third node a plane.
std::vector<Contour> contours() {
  std::vector<Contour> out;
  std::mt19937_64 random(7);
  while (out.size() < 40) {
    auto node = random_node(random, true, out.size() % 2 == 0, false);
    if (out.size() % 3 == 0) node.cutters.emplace_back(PlaneCutter{{0, 0, 5}, {0.3, -0.2, 1}});
    if (auto contour = trace(node.cutters, node.rho)) out.push_back(std::move(*contour));
  }
  return out;
}

std::vector<double> phases(std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = kTwoPi * static_cast<double>(i) / static_cast<double>(n);
  return out;
}

/// Numbers that are no numbers on both sides count as the same.
void expect_same(double a, double b) {
  if (std::isnan(a) && std::isnan(b)) return;
  EXPECT_EQ(a, b);
}

TEST(Stations, EqualTheirSingleGenerators) {
  const auto phi = phases(361);
  for (const auto& contour : contours()) {
    const auto stations = stations_at(contour.radius, phi);
    const auto contacts = contacts_at(contour, stations, phi);
    const auto normals = normals_at(contour.cutters, stations, contacts.cutter);
    const Wall wall{contour.radius, 1.2 * contour.radius};
    const auto steep = steepest_at(contour.cutters, wall, stations, contacts.z);
    std::vector<double> slopes(phi.size());
    slopes_of(contour.cutters.front(), stations, slopes);
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const auto line = generator_at(contour.radius, phi[i]);
      const auto contact = contact_at(contour, phi[i]);
      expect_same(contacts.z[i], contact.z);
      EXPECT_EQ(contacts.cutter[i], contact.cutter);
      const auto normal = continued_hit(contour.cutters[contact.cutter], line).normal;
      expect_same(normals.radial[i], normal.x());
      expect_same(normals.tangential[i], normal.y());
      expect_same(normals.axial[i], normal.z());
      expect_same(slopes[i], continued_hit(contour.cutters.front(), line).z_dphi);
      double steepest_one = -std::numeric_limits<double>::infinity();
      for (const auto& cutter : contour.cutters)
        steepest_one = std::max(steepest_one, steepest(cutter, wall, line, contact.z));
      expect_same(steep[i], steepest_one);
    }
  }
}

TEST(SolidArrays, EqualTheSingleSolids) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> any(-90, 90);
  const auto point = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
  for (int n = 0; n < 20; ++n) {
    const auto node = random_node(random, true, false, false);
    for (const auto& cutter : node.cutters) {
      const Solid solid(cutter);
      PointArrays from(37), to(37);
      for (std::size_t i = 0; i < from.size(); ++i) {
        from.set(i, point());
        to.set(i, i % 9 == 4 ? from.at(i) : point());
      }
      std::vector<double> distance(37), least(37);
      distances(solid, from, distance);
      least_distances(solid, from, to, least);
      for (std::size_t i = 0; i < from.size(); ++i) {
        EXPECT_NEAR(distance[i], solid.distance(from.at(i)), 1e-12);
        EXPECT_NEAR(least[i], solid.least_distance(from.at(i), to.at(i)), 1e-12);
      }
      by_kind(solid.kind(), [&]<class Kind>(const Kind& kind) {
        if constexpr (PlainSolid<Kind>) {
          std::vector<double> share(37);
          nearest_on_ways(kind, from, to, share, distance);
          for (std::size_t i = 0; i < from.size(); ++i) {
            const Eigen::Vector3d a = from.at(i), b = to.at(i);
            EXPECT_NEAR(share[i], kind.nearest_share(a, b), 1e-12);
            EXPECT_NEAR(distance[i], kind.distance(a + share[i] * (b - a)), 1e-12);
          }
        }
      });
    }
  }
}

/// Simpson, halved until it does not change, over phi = from + (to - from) sin^2 t.
double slow_length(const PreparedCutter& cutter, double rho, double from, double to) {
  const auto speed = [&](double t) {
    const double s = std::sin(t);
    const auto line = generator_at(rho, from + (to - from) * s * s);
    const double slope = continued_hit(cutter, line).z_dphi;
    return std::isfinite(slope) ? std::hypot(rho, slope) * (to - from) * std::sin(2 * t) : 0.0;
  };
  double before = 0.0;
  for (int parts = 8; parts <= 1 << 15; parts *= 2) {
    const double h = 0.5 * kPi / parts;
    double sum = 0.0;
    for (int k = 0; k < parts; ++k)
      sum += h / 6 * (speed(k * h) + 4 * speed((k + 0.5) * h) + speed((k + 1) * h));
    if (std::abs(sum - before) <= 1e-13 * sum) return sum;
    before = sum;
  }
  return before;
}

TEST(Length, FixedRuleAgreesWithASlowAdaptiveOne) {
  std::vector<Contour> all{*trace(table1(), 35), *trace(table1(), 30)};
  for (auto& contour : contours())
    if (all.size() < 12) all.push_back(std::move(contour));
  for (const auto& contour : all)
    for (const std::size_t n : {12, 90}) {
      const auto phi = phases(n);
      const auto lengths = lengths_along(contour, phi);
      for (std::size_t i = 0; i + 1 < n; ++i) {
        const auto& segment = segment_at(contour, phi[i]);
        const double from = phi[i] < segment.from ? phi[i] + kTwoPi : phi[i];
        const double to = from + kTwoPi / static_cast<double>(n);
        if (to > segment.to) continue;  // an event between
        const double slow = slow_length(contour.cutters[segment.cutter], contour.radius, from, to);
        EXPECT_NEAR(lengths[i + 1] - lengths[i], slow, 1e-9 * lengths.back()) << phi[i];
      }
    }
}

}  // namespace
}  // namespace tubecut::joint
