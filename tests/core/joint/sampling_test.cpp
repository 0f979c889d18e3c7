#include "core/joint/sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/joint/length.hpp"
#include "tests/core/joint/published.hpp"
#include "tests/core/joint/random_nodes.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::joint {
namespace {

std::vector<double> phases(const Contour& contour) {
  std::vector<double> out;
  for (const auto& event : contour.events) out.push_back(event.phi);
  return out;
}

/// Largest distance of 66 points of the curve from each chord between neighbouring nodes.
double deviation(const Contour& contour, const std::vector<Node>& nodes, Metric metric) {
  const auto placed = [&](double phi, double z) -> Eigen::Vector3d {
    if (metric == Metric::developed) return {contour.radius * phi, z, 0};
    return {contour.radius * std::cos(phi), contour.radius * std::sin(phi), z};
  };
  double worst = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const bool last = k + 1 == nodes.size();
    const auto& next = nodes[last ? 0 : k + 1];
    const double end = next.phi + (last ? kTwoPi : 0.0);
    const Eigen::Vector3d a = placed(nodes[k].phi, nodes[k].z);
    const Eigen::Vector3d along = placed(end, next.z) - a;
    for (int i = 1; i <= 66; ++i) {
      const double phi = nodes[k].phi + (end - nodes[k].phi) * i / 67;
      const double z = contact_at(contour, phi < kTwoPi ? phi : phi - kTwoPi).z;
      const Eigen::Vector3d to = placed(phi, z) - a;
      const double along2 = along.squaredNorm();
      if (end == nodes[k].phi) continue;
      worst = std::max(worst, (to - to.dot(along) / along2 * along).norm());
    }
  }
  return worst;
}

TEST(Sampling, DeviationStaysWithinTheTolerance) {
  const auto golden = testing::golden(kGolden);
  for (const auto& contour :
       {trace(table1(), 35), trace(table1(), 30), trace(eccentric_cutters(golden), 60),
        trace(std::vector<Cutter>{tube_deg(40, 60, 20, 0)}, 40)}) {
    ASSERT_TRUE(contour);
    for (const auto metric : {Metric::developed, Metric::chord})
      for (const double tolerance : {0.1, 0.01, 0.001}) {
        const auto samples = sample(*contour, {.tolerance = Tolerance{tolerance, metric}});
        ASSERT_TRUE(samples);
        EXPECT_LE(deviation(*contour, samples->nodes, metric), tolerance * (1 + 1e-6));
      }
  }
}

TEST(Sampling, UniformIsTheBareGrid) {
  const auto contour = trace(table1(), 35);
  const auto also = phases(*contour);
  const auto samples = sample(*contour, {.uniform_points = 360}, also);
  ASSERT_TRUE(samples);
  ASSERT_EQ(samples->nodes.size(), 360U);
  for (std::size_t i = 0; i < 360; ++i) {
    EXPECT_DOUBLE_EQ(samples->nodes[i].phi, kTwoPi * static_cast<double>(i) / 360);
    EXPECT_EQ(samples->nodes[i].kind, NodeKind::smooth);
  }
  EXPECT_GT(deviation(*contour, samples->nodes, Metric::developed), 0.3);
}

TEST(Sampling, BothTogetherAreTheUnionWithEventsOfBothWalls) {
  const auto golden = testing::golden(kGolden);
  const auto inner = trace(eccentric_cutters(golden), 54);
  const auto outer = trace(eccentric_cutters(golden), 60);
  const auto samples =
      sample(*inner, {.uniform_points = 360, .tolerance = Tolerance{0.05}}, phases(*outer));
  ASSERT_TRUE(samples);
  const auto& nodes = samples->nodes;
  const auto count = [&](double phi, double reach) {
    return std::ranges::count_if(nodes,
                                 [&](const Node& n) { return std::abs(n.phi - phi) <= reach; });
  };
  for (const auto& event : inner->events)
    EXPECT_EQ(count(event.phi, 0), event.kind == EventKind::jump ? 2 : 1);
  for (const auto& event : outer->events) EXPECT_EQ(count(event.phi, 1e-15), 1) << event.phi;
  for (int i = 0; i < 360; ++i) EXPECT_GE(count(kTwoPi * i / 360, 1e-6 / 54), 1);
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    if (nodes[k].kind == NodeKind::jump && nodes[k + 1].phi == nodes[k].phi) continue;
    EXPECT_GT(54 * (nodes[k + 1].phi - nodes[k].phi), 0.99e-6);
  }
}

TEST(Sampling, NodesOnAnEventHaveTwoSides) {
  // Corners at 30 and 210 deg are grid points as well.
  const auto contour = trace(std::vector<Cutter>{tube_deg(40, 90, 30, 0)}, 40);
  const auto samples = sample(*contour, {.uniform_points = 12});
  ASSERT_TRUE(samples);
  int corners = 0;
  for (const auto& node : samples->nodes) {
    if (node.kind != NodeKind::kink) continue;
    ++corners;
    const auto sides = hits_at(*contour, node);
    EXPECT_NEAR(sides.before.z_dphi, -40, 1e-9);
    EXPECT_NEAR(sides.after.z_dphi, 40, 1e-9);
    EXPECT_NEAR(sides.before.normal.norm(), 1, 1e-12);
  }
  EXPECT_EQ(corners, 2);
}

// The corner's closed one-sided limits against points closer and closer to it.
TEST(Sampling, CornerIsTheLimitOfItsNeighbours) {
  for (const double offset : {15.0, -15.0}) {
    const auto contour = trace(std::vector<Cutter>{tube_deg(50, 60, 100, offset, 7)}, 35);
    ASSERT_EQ(contour->events.size(), 1U);
    const double phi = contour->events.front().phi;
    const auto sides = hits_at(*contour, {.phi = phi, .kind = NodeKind::kink});
    EXPECT_NEAR(sides.before.z, 7, 1e-12);
    for (const double step : {1e-4, 1e-5}) {
      const auto before = *hit(contour->cutters[0], generator_at(35, phi - step));
      const auto after = *hit(contour->cutters[0], generator_at(35, phi + step));
      const auto lean = [](const Hit& h) { return std::atan2(h.normal.y(), h.normal.z()); };
      EXPECT_NEAR(lean(sides.before), lean(before), 2 * step);
      EXPECT_NEAR(lean(sides.after), lean(after), 2 * step);
      EXPECT_NEAR(sides.before.z_dphi, before.z_dphi, 200 * step);
      EXPECT_NEAR(sides.after.z_dphi, after.z_dphi, 200 * step);
    }
  }
}

TEST(Sampling, Errors) {
  const auto contour = trace(table1(), 35);
  const auto many = sample(*contour, {.tolerance = Tolerance{1e-4}, .max_nodes = 1000});
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().code(), ErrorCode::too_many_nodes);
  EXPECT_EQ(std::get<double>(many.error().issues.front().limit), 1000);
  EXPECT_EQ(sample(*contour, {.uniform_points = 1'000'000}).error().code(),
            ErrorCode::too_many_nodes);
  EXPECT_EQ(sample(*contour, {}).error().code(), ErrorCode::out_of_range);
  EXPECT_EQ(sample(*contour, {.tolerance = Tolerance{0.0}}).error().code(),
            ErrorCode::out_of_range);
  const CancelledScope cancelled;
  EXPECT_EQ(sample(*contour, {.tolerance = Tolerance{0.1}}, {}).error().code(),
            ErrorCode::cancelled);
}

TEST(Length, ColumnAgreesWithAFinePolylineAndWithTheTotal) {
  const auto golden = testing::golden(kGolden);
  std::vector<Result<Contour>> contours{trace(table1(), 35), trace(eccentric_cutters(golden), 60)};
  std::mt19937_64 random(21);
  for (int n = 0; n < 6; ++n) {
    const auto node = random_node(random, true, n % 2 == 0, false);
    contours.push_back(trace(node.cutters, node.rho));
  }
  for (const auto& contour : contours) {
    ASSERT_TRUE(contour);
    const auto fine = sample(*contour, {.tolerance = Tolerance{1e-4, Metric::chord}});
    ASSERT_TRUE(fine);
    const auto& nodes = fine->nodes;
    EXPECT_NEAR(fine->true_length, true_length(*contour), 1e-9 * fine->true_length);
    double polyline = nodes.front().length;
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      const auto& a = nodes[k];
      const auto& b = nodes[k + 1];
      const double across = 2 * contour->radius * std::sin(0.5 * (b.phi - a.phi));
      polyline += std::hypot(across, b.z - a.z);
      EXPECT_NEAR(b.length, polyline, 2e-4 * polyline / 10) << k;
    }
    const auto coarse = sample(*contour, {.uniform_points = 8});
    EXPECT_NEAR(coarse->true_length, fine->true_length, 1e-9 * fine->true_length);
    EXPECT_EQ(coarse->nodes.front().length, 0);
  }
}

}  // namespace
}  // namespace tubecut::joint
