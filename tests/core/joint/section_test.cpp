#include "core/joint/section.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/bevel/angles.hpp"
#include "core/joint/solid.hpp"

// The core pipeline on a target that is not round: the end of a rectangular prism against round
// cutters, from generator to highest hit, partner, bevel and sampled contour.

namespace tubecut::joint {
namespace {

const RectangularSection kSection{.width = 100, .height = 60, .corner = 9};
const std::vector<Cutter> kCutters{
    TubeCutter{
        .radius = 110, .inclination = Angle::deg(65), .clocking = Angle::deg(20), .offset = 12},
    TubeCutter{.radius = 30,
               .inclination = Angle::deg(50),
               .clocking = Angle::deg(200),
               .offset = 5,
               .height = 130}};
constexpr double kTolerance = 0.02;

double between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return 2.0 * std::atan2((a - b).norm(), (a + b).norm());
}

Eigen::Vector3d placed(const SectionPoint& g, double z) { return {g.at.x(), g.at.y(), z}; }

TEST(Section, PerimeterAndNormalsClose) {
  const double p = kSection.perimeter();
  EXPECT_NEAR(p, 2 * (100 + 60) - 8 * 9 + 2 * kPi * 9, 1e-12);
  SectionPoint last = kSection.at(0.0);
  double length = 0.0;
  constexpr int kSteps = 20'000;
  for (int k = 1; k <= kSteps; ++k) {
    const auto here = kSection.at(std::min(p * k / kSteps, p * (1 - 1e-15)));
    const Eigen::Vector2d step = here.at - last.at;
    length += step.norm();
    EXPECT_NEAR(here.normal.norm(), 1.0, 1e-14);
    EXPECT_NEAR(step.normalized().dot(last.normal), 0.0, 2e-3);  // the tangent
    EXPECT_GT(step.dot(last.tangent()), 0.0);
    last = here;
  }
  EXPECT_NEAR(length, p, 1e-4);
  EXPECT_NEAR((kSection.at(0.0).at - Eigen::Vector2d(50, 0)).norm(), 0.0, 1e-13);
}

TEST(Section, PrismEndAgainstRoundCutters) {
  const auto nodes = section_contour(kCutters, kSection, kTolerance);
  ASSERT_TRUE(nodes);
  std::vector<Solid> solids;
  for (const auto& cutter : kCutters) solids.emplace_back(cutter);
  const bevel::Rule rule(bevel::HalfDihedral{}, bevel::Dihedral::weld_side);
  std::size_t of_second = 0;
  for (const auto& node : *nodes) {
    const auto p = placed(node.generator, node.hit.z);
    EXPECT_NEAR(solids[node.cutter].distance(p), 0.0, 1e-10);
    for (const auto& solid : solids) EXPECT_GT(solid.distance(p), -1e-10);
    of_second += node.cutter;
    // Dihedral from the two surfaces' normals in space; B from the bevel plane, both by vectors.
    const Eigen::Vector3d n(node.generator.normal.x(), node.generator.normal.y(), 0.0);
    const Eigen::Vector3d m = solids[node.cutter].normal(p);
    const auto angles = rule.angles(node.hit.normal);
    EXPECT_NEAR(angles.dihedral, between(n, -m), 1e-12);
    const Eigen::Vector3d t = n.cross(m).normalized();
    Eigen::Vector3d across = t.cross(n);
    if (across.z() < 0) across = -across;
    const Eigen::Vector3d bevel_line = std::cos(angles.tau) * n + std::sin(angles.tau) * across;
    const Eigen::Vector3d torch =
        std::cos(angles.b) * n + std::sin(angles.b) * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(torch.dot(t.cross(bevel_line).normalized()), 0.0, 1e-12);
  }
  EXPECT_GT(of_second, 10u);
  EXPECT_LT(of_second, nodes->size() - 10);
  // Between the nodes no generator's hit is further than asked from the straight line.
  const double p = kSection.perimeter();
  double worst = 0.0;
  for (std::size_t i = 0; i < nodes->size(); ++i) {
    const auto& a = (*nodes)[i];
    const auto& b = (*nodes)[(i + 1) % nodes->size()];
    const double to = b.s > a.s ? b.s : b.s + p;
    for (const double t : {0.15, 0.4, 0.65, 0.9}) {
      const double s = a.s + t * (to - a.s);
      const auto generator = kSection.at(s < p ? s : s - p);
      double top = -1e300;
      for (const auto& solid : solids)
        top = std::max(top, solid.top(generator.at.x(), generator.at.y()).value_or(-1e300));
      const double line = a.hit.z + t * (b.hit.z - a.hit.z);
      const double slope = (b.hit.z - a.hit.z) / (to - a.s);
      worst = std::max(worst, std::abs(top - line) / std::hypot(1.0, slope));
    }
  }
  EXPECT_LT(worst, kTolerance);
}

TEST(Section, WithHalfTheSideAsCornerItIsRound) {
  const RectangularSection round{.width = 70, .height = 70, .corner = 35};
  const auto prepared = prepare(kCutters[0]);
  for (int k = 0; k < 360; ++k) {
    const double phi = k * kRadPerDeg;
    const auto a = hit(*prepared, round.at(35.0 * phi));
    const auto b = hit(*prepared, generator_at(35.0, phi));
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->z, b->z, 1e-11);
    EXPECT_LT((a->normal - b->normal).norm(), 1e-12);
    EXPECT_NEAR(35.0 * a->z_dphi, b->z_dphi, 1e-10);
  }
}

TEST(Section, WhatIsNotMetIsNamed) {
  const std::vector<Cutter> thin{TubeCutter{.radius = 20, .inclination = Angle::deg(90)}};
  EXPECT_EQ(section_contour(thin, kSection, 0.1).error().code(), ErrorCode::open_profile);
  EXPECT_EQ(
      section_contour(kCutters, {.width = 100, .height = 60, .corner = 31}, 0.1).error().code(),
      ErrorCode::out_of_range);
}

}  // namespace
}  // namespace tubecut::joint
