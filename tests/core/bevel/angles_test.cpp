#include "core/bevel/table/angles.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/joint/contour.hpp"
#include "core/joint/placement.hpp"
#include "core/joint/sampling.hpp"
#include "tests/core/joint/published.hpp"

namespace tubecut::bevel {
namespace {

using testing::number;
using testing::numbers;

constexpr double kDeg = 1e-9;  // tolerance of angles

joint::Contour traced(const std::vector<joint::Cutter>& cutters, double rho) {
  auto contour = joint::trace(cutters, rho);
  EXPECT_TRUE(contour);
  return *std::move(contour);
}

Angles angles_at(const joint::Contour& contour, std::size_t degree, Dihedral dihedral,
                 const GrooveRule& rule = HalfDihedral{}) {
  const double phi = Angle::deg(static_cast<double>(degree)).rad();
  const auto line = joint::generator_at(contour.radius, phi);
  const auto& cutter = contour.cutters[joint::contact_at(contour, phi).cutter];
  return Rule(rule, dihedral)
      .angles(dihedral == Dihedral::as_published ? joint::published_normal(cutter, line)
                                                 : joint::hit(cutter, line)->normal);
}

void expect_angles(const api::Json& golden, const std::string& block,
                   const joint::Contour& contour) {
  const auto psi = numbers(golden, block + "/psi");
  const auto omega_n = numbers(golden, block + "/omega_n");
  const auto gamma = numbers(golden, block + "/gamma");
  const auto tau = numbers(golden, block + "/tau");
  const auto b = numbers(golden, block + "/B");
  const auto omega = numbers(golden, block + "/literal/omega");
  const auto wrong_gamma = numbers(golden, block + "/literal/gamma");
  const auto wrong_b = numbers(golden, block + "/literal/B");
  ASSERT_EQ(b.size(), 360U);
  for (std::size_t i = 0; i < b.size(); ++i) {
    const auto weld = angles_at(contour, i, Dihedral::weld_side);
    EXPECT_NEAR(weld.dihedral * kDegPerRad, psi[i], kDeg) << block << i;
    EXPECT_NEAR(weld.gamma * kDegPerRad, gamma[i], kDeg) << block << i;
    EXPECT_NEAR(weld.tau * kDegPerRad, tau[i], kDeg) << block << i;
    EXPECT_NEAR(weld.b * kDegPerRad, b[i], kDeg) << block << i;
    const auto inside = angles_at(contour, i, Dihedral::inside);
    EXPECT_NEAR(inside.dihedral * kDegPerRad, omega_n[i], kDeg) << block << i;
    EXPECT_NEAR(inside.gamma * kDegPerRad, gamma[i], kDeg) << block << i;
    const auto published = angles_at(contour, i, Dihedral::as_published);
    EXPECT_NEAR(published.dihedral * kDegPerRad, omega[i], kDeg) << block << i;
    EXPECT_NEAR(published.gamma * kDegPerRad, wrong_gamma[i], kDeg) << block << i;
    EXPECT_NEAR(published.b * kDegPerRad, wrong_b[i], kDeg) << block << i;
  }
}

TEST(AnglesGolden, Table1AndEccentric) {
  const auto golden = testing::golden(joint::kGolden);
  expect_angles(golden, "seed000_table1_r35", traced(joint::table1(), 35));
  expect_angles(golden, "seed000_table1_r30", traced(joint::table1(), 30));
  expect_angles(golden, "eccentric", traced(joint::eccentric_cutters(golden), 60));
}

TEST(AnglesGolden, StepsOfTheThreeDihedrals) {
  const auto contour = traced(joint::table1(), 35);
  struct Row {
    std::size_t sample;
    double published, inside, weld;
  };
  constexpr Row kRows[] = {{16, 16.16, 11.75, -51.49},
                           {102, 25.58, 33.90, 0.76},
                           {216, -41.79, -57.36, 16.18},
                           {260, 5.58, -2.59, -11.80},
                           {319, -20.33, -18.74, 24.31}};
  const auto step = [&](std::size_t i, Dihedral dihedral) {
    return (angles_at(contour, i + 1, dihedral).b - angles_at(contour, i, dihedral).b) * kDegPerRad;
  };
  for (const auto& row : kRows) {
    EXPECT_NEAR(step(row.sample, Dihedral::as_published), row.published, 0.005);
    EXPECT_NEAR(step(row.sample, Dihedral::inside), row.inside, 0.005);
    EXPECT_NEAR(step(row.sample, Dihedral::weld_side), row.weld, 0.005);
  }
}

TEST(AnglesGolden, OffsetPairOfThePatent) {
  const auto golden = testing::golden(joint::kGolden);
  const double t = number(golden, "seed002/t");
  const auto contour = traced({joint::tube_deg(150, 60, 90, -20)}, 70);
  const auto psi = numbers(golden, "seed002/psi");
  const auto bevel = numbers(golden, "seed002/bevel");
  const auto tau = numbers(golden, "seed002/tau");
  const auto gamma = numbers(golden, "seed002/gamma");
  const auto omega = numbers(golden, "seed002/omega");
  const auto z_out = numbers(golden, "seed002/z_out");
  ASSERT_EQ(psi.size(), 360U);
  for (std::size_t i = 0; i < psi.size(); ++i) {
    const auto a = angles_at(contour, i, Dihedral::weld_side);
    EXPECT_NEAR(a.dihedral * kDegPerRad, psi[i], kDeg);
    EXPECT_NEAR(a.groove * kDegPerRad, bevel[i], kDeg);
    EXPECT_NEAR(a.tau * kDegPerRad, tau[i], kDeg);
    EXPECT_NEAR(a.gamma * kDegPerRad, gamma[i], kDeg);
    EXPECT_NEAR(a.b * kDegPerRad, omega[i], kDeg);
    const double z = joint::contact_at(contour, Angle::deg(static_cast<double>(i)).rad()).z;
    EXPECT_NEAR(z + t * std::tan(a.b), z_out[i], 1e-10);
  }
}

/// A random tube, a point of its curve, and all its angles by only vectors.
struct Built {
  Eigen::Vector3d radial, round, axial, outward, along, half_target, half_cutter;
};

Built build(const joint::TubeCutter& tube, double rho, double phi, double z) {
  Built b;
  b.radial = {std::cos(phi), std::sin(phi), 0};
  b.round = {-std::sin(phi), std::cos(phi), 0};
  b.axial = {0, 0, 1};
  const auto axis = joint::axis_of(tube);
  const Eigen::Vector3d p = rho * b.radial + z * b.axial;
  const Eigen::Vector3d from_axis = p - axis.point;
  b.outward = (from_axis - from_axis.dot(axis.direction) * axis.direction).normalized();
  b.along = b.outward.cross(b.radial).normalized();
  if (b.along.dot(b.round) < 0) b.along = -b.along;
  // Half tangents in the normal section: the target's kept side, the cutter's side outside both.
  b.half_target = b.along.cross(b.radial);
  if (b.half_target.z() < 0) b.half_target = -b.half_target;
  b.half_cutter = b.along.cross(b.outward);
  if (b.half_cutter.dot(b.radial) < 0) b.half_cutter = -b.half_cutter;
  return b;
}

TEST(Angles, AgreeWithVectorsInSpace) {
  std::mt19937_64 random(7);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int tried = 0;
  while (tried < 2000) {
    const joint::TubeCutter tube{any(20, 90), Angle::deg(any(15, 165)), Angle::deg(any(0, 360)),
                                 any(-40, 40), any(-20, 20)};
    const double rho = any(15, 60);
    const double phi = any(0, kTwoPi);
    const auto hit = joint::hit(tube, rho, Angle::rad(phi));
    if (!hit || hit->normal.z() < 0.05 || std::abs(hit->normal.x()) > 0.999) continue;
    ++tried;
    const auto b = build(tube, rho, phi, hit->z);
    EXPECT_NEAR(hit->normal.x(), b.outward.dot(b.radial), 1e-13);
    EXPECT_NEAR(hit->normal.y(), b.outward.dot(b.round), 1e-13);
    EXPECT_NEAR(hit->normal.z(), b.outward.dot(b.axial), 1e-13);
    const auto a = Rule(HalfDihedral{}, Dihedral::weld_side).angles(hit->normal);
    // The weld-side dihedral lies between the half tangents of the target and of the cutter.
    const double psi = std::acos(std::clamp(b.half_target.dot(b.half_cutter), -1.0, 1.0));
    EXPECT_NEAR(a.dihedral, psi, 1e-7);
    EXPECT_NEAR(std::tan(a.gamma), -hit->z_dphi / rho, 1e-9 * (1.0 + std::abs(hit->z_dphi)));
    // The bevel plane holds the tangent and a line at `groove` from the cutter, in the section.
    const double elevation = 0.5 * kPi - a.dihedral + a.groove;
    const Eigen::Vector3d bevel =
        std::cos(elevation) * b.radial + std::sin(elevation) * b.half_target;
    const Eigen::Vector3d torch = std::cos(a.b) * b.radial + std::sin(a.b) * b.axial;
    EXPECT_NEAR(torch.dot(b.along.cross(bevel)), 0.0, 1e-12);
    EXPECT_NEAR(std::tan(a.flush), -b.outward.dot(b.radial) / b.outward.dot(b.axial),
                1e-9 / hit->normal.z());
  }
}

TEST(Angles, GrooveRules) {
  const Eigen::Vector3d n = Eigen::Vector3d(-0.3, 0.5, 0.7).normalized();
  const auto half = Rule(HalfDihedral{}, Dihedral::weld_side).angles(n);
  EXPECT_NEAR(half.groove, 0.5 * half.dihedral, 1e-15);
  const auto capped = Rule(HalfDihedral{Angle::deg(20)}, Dihedral::weld_side).angles(n);
  EXPECT_NEAR(capped.groove, 20 * kRadPerDeg, 1e-15);
  const auto fixed = Rule(FixedGroove{Angle::deg(20)}, Dihedral::weld_side).angles(n);
  EXPECT_EQ(fixed.b, capped.b);
  EXPECT_NEAR(fixed.b, std::atan(std::tan(fixed.tau) / std::cos(fixed.gamma)), 1e-14);
  const auto none = Rule(NoGroove{}, Dihedral::weld_side).angles(n);
  EXPECT_EQ(none.groove, 0.0);
  EXPECT_NEAR(none.b, none.flush, 1e-15);
  const auto square = Rule(SquareCut{}, Dihedral::weld_side).angles(n);
  EXPECT_EQ(square.b, 0.0);
  EXPECT_EQ(square.tau, 0.0);
  EXPECT_NEAR(square.groove, square.dihedral - 0.5 * kPi, 1e-15);
}

TEST(Angles, HalfDihedralIsContinuousAtTheCap) {
  const Rule rule(HalfDihedral{}, Dihedral::weld_side);
  for (const double lean : {-1.2, 0.0, 0.9}) {
    const auto normal = [&](double psi) {
      return Eigen::Vector3d(-std::cos(psi), std::sin(psi) * std::sin(lean),
                             std::sin(psi) * std::cos(lean));
    };
    const double step = 1e-9;
    EXPECT_NEAR(rule.angles(normal(0.5 * kPi - step)).b, rule.angles(normal(0.5 * kPi + step)).b,
                1e-8);
  }
}

// Equal radii at a right angle: at the corner B has no limit, only two one-sided ones.
TEST(Angles, CornerOfEqualTubes) {
  const auto contour = traced({joint::tube_deg(40, 90, 30, 0)}, 40);
  ASSERT_EQ(contour.events.size(), 2U);
  const auto samples = joint::sample(contour, {.tolerance = joint::Tolerance{}});
  ASSERT_TRUE(samples);
  const Rule rule(HalfDihedral{}, Dihedral::weld_side);
  int corners = 0;
  for (const auto& node : samples->nodes) {
    if (node.kind != joint::NodeKind::kink) continue;
    ++corners;
    const auto sides = joint::hits_at(contour, node);
    EXPECT_NEAR(rule.angles(sides.before.normal).gamma * kDegPerRad, 45, 1e-9);
    EXPECT_NEAR(rule.angles(sides.after.normal).gamma * kDegPerRad, -45, 1e-9);
    EXPECT_NEAR(rule.angles(sides.before.normal).b * kDegPerRad, -54.7356, 1e-4);
    EXPECT_NEAR(rule.angles(sides.after.normal).b * kDegPerRad, -54.7356, 1e-4);
  }
  EXPECT_EQ(corners, 2);
}

// Where the surfaces touch, B is the limit of its neighbours along the tube: tau.
TEST(Angles, TouchingSurfacesHaveTheLimitNearby) {
  constexpr double kOffTouch = 1e-6;
  for (const GrooveRule& rule : {GrooveRule{NoGroove{}}, GrooveRule{HalfDihedral{}},
                                 GrooveRule{FixedGroove{Angle::deg(20)}}})
    for (const double radial : {1.0, -1.0}) {
      const Rule of(rule, Dihedral::weld_side);
      const double touching = of.angles({radial, 0.0, 0.0}).b;
      const double nearby = of.angles({radial * std::cos(kOffTouch), 0.0, std::sin(kOffTouch)}).b;
      EXPECT_NEAR(touching, of.angles({radial, 0.0, 0.0}).tau, 1e-12);
      EXPECT_NEAR(touching, nearby, 10.0 * kOffTouch);
      Angles many;
      joint::Normals one;
      one.radial = {radial};
      one.tangential = one.axial = {0.0};
      of.angles(one, {&many, 1});
      EXPECT_EQ(many.b, touching);
    }
}

}  // namespace
}  // namespace tubecut::bevel
