#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/cutout/cone.hpp"
#include "core/cutout/cutout.hpp"
#include "core/math/cylinder.hpp"
#include "core/math/quadrature.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"
#include "tests/core/cutout/square_ends.hpp"
#include "tests/support/golden.hpp"

/// Countersinks: an independent program, closed forms, and what holds of any cone.
namespace tubecut::testing {
namespace {

using namespace cutout;
using api::Json;
using Eigen::Vector3d;
using Sinks = std::mt19937;

double drawn(Sinks& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

Spec sunk(double hole, double diameter, double degrees) {
  Spec out{.id = "s", .shape = Circle{hole}};
  out.at = {.z = 100.0, .phi = 0.4};
  out.tilt = bevel::Tilt::free;
  out.countersink = {.diameter = diameter, .angle = degrees * kRadPerDeg};
  return out;
}

/// A cone that its tube admits, of any kind: with a land, without one, open at the sides.
struct Drawn {
  joint::Target tube;
  Spec spec;
  double kerf = 0.0;
};
Drawn drawn_cone(Sinks& random) {
  while (true) {
    const double outer = drawn(random, 15.0, 90.0);
    Drawn out{.tube = {.outer_radius = outer, .wall = drawn(random, 1.5, 0.25 * outer)}};
    const double hole = drawn(random, 3.0, 0.9 * outer);
    out.spec = sunk(hole, hole + drawn(random, 0.1, 0.6 * outer), drawn(random, 30.0, 140.0));
    out.kerf = drawn(random, 0.1, 2.0);
    if (lay({out.spec}, {.tube = out.tube, .kerf = out.kerf})) return out;
  }
}

const Mould& cone_of(const Layout& layout) { return layout.mould_of(layout.instances.at(1)); }

section::Section square_tube(const Json& of) {
  return {number(of, "section/H"), number(of, "section/W"), number(of, "section/t"),
          number(of, "section/ro"), number(of, "section/ri")};
}

TEST(Countersink, PointsAnglesAndVolumesAreThoseOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  const auto& cases = *at(all, "countersinks").as<Json::Array>();
  ASSERT_EQ(cases.size(), 3u);
  for (const auto& one : cases) {
    auto spec = sunk(number(one, "diameter_mm"), number(one, "countersink/diameter_mm"),
                     number(one, "countersink/angle_deg"));
    Ground ground{
        .tube = {.outer_radius = 0.5 * number(one, "section/H"), .wall = number(one, "section/t")},
        .tolerance = 1e3};  // so coarse that the rows are 15 deg apart, as there
    const bool round = *at(one, "section/round").as<bool>();
    spec.at.phi = number(one, "at/s_mm") / (number(one, "section/girth") / kTwoPi);
    if (!round) {
      ground.section.emplace(square_tube(one));
      spec.at.face = 1;
    }
    const auto layout = lay({spec}, ground).value();
    ASSERT_EQ(layout.instances.size(), 2u);
    const auto& mould = cone_of(layout);
    const auto rows = placed(layout, layout.instances[1]);
    EXPECT_NEAR(mould.cone->depth(), number(one, "depth_mm"), 1e-10);
    const auto b = numbers(one, "b_deg"), a = numbers(one, "a_deg");
    ASSERT_EQ(rows.phi.size(), b.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
      const double w = kTwoPi * static_cast<double>(i) / static_cast<double>(b.size());
      for (const bool outer : {true, false}) {
        const auto* side = outer ? "outer" : "inner";
        EXPECT_NEAR(cone_radius(mould.laying, *mould.cone, w, outer),
                    numbers(one, (std::string("cone_radius_") + side).c_str())[i], 1e-9);
        const auto& row = (*at(one, side).as<Json::Array>())[i];
        const Vector3d wanted(number(row, "0"), number(row, "1"), number(row, "2"));
        const double phi = outer ? rows.phi[i] : rows.phi_inner[i];
        const double z = outer ? rows.z[i] : rows.z_inner[i];
        Vector3d got = math::cylinder_point(
            outer ? ground.tube.outer_radius : ground.tube.inner_radius(), phi, z);
        if (!round) {
          const auto& curve = outer ? ground.section->outer() : ground.section->bore();
          const auto p = curve.at(phi / kTwoPi * curve.girth()).point;
          got = {p.x(), p.y(), z};
        }
        // The file has the cone itself, which on the bore may lie within its circle.
        if (cone_radius(mould.laying, *mould.cone, w, outer) >= 0.5 * mould.cone->hole) {
          EXPECT_LT((got - wanted).norm(), 1e-9) << text(one, "name") << i;
        }
      }
      EXPECT_NEAR(rows.b[i] * kDegPerRad, b[i], 1e-8);
      EXPECT_NEAR(rows.a[i] * kDegPerRad, a[i], 1e-8);
    }
    const double both = mould.taken.volume + layout.moulds[0].taken.volume;
    EXPECT_NEAR(both, number(one, "volume"), 1e-5) << text(one, "name");
  }
}

TEST(Countersink, OnAFlatIsAFrustum) {
  const section::Section tube{100, 60, 5, 10, 5};
  for (const double depth : {2.0, 5.0, 9.0}) {  // a land, to the bore, through it
    const double slope = std::tan(41.0 * kRadPerDeg);
    auto spec = sunk(8.0, 8.0 + 2.0 * depth * slope, 82.0);
    spec.at.face = 2;
    const auto layout =
        lay({spec}, {.tube = {.outer_radius = 50, .wall = 5}, .section = section::Wall(tube)})
            .value();
    const double upper = 4.0 + depth * slope, tall = std::min(depth, 5.0);
    const double lower = upper - tall * slope;
    const double frustum = kPi * tall / 3.0 * (upper * upper + upper * lower + lower * lower);
    const auto& taken = cone_of(layout).taken;
    EXPECT_NEAR(taken.volume, frustum - kPi * 16.0 * tall, 1e-9);
    EXPECT_NEAR(taken.outer_area, kPi * (upper * upper - 16.0), 1e-9);
    EXPECT_NEAR(taken.inner_area, kPi * (std::max(lower, 4.0) * std::max(lower, 4.0) - 16.0), 1e-9);
  }
}

/// As the tube grows, the cone becomes that of a flat; what is lost at the sides falls as 1/R.
TEST(Countersink, OfAWideTubeIsThatOfAFlat) {
  const double slope = std::tan(0.25 * kPi), upper = 9.0, lower = 9.0 - 4.0 * slope;
  const double flat =
      kPi * 4.0 / 3.0 * (upper * upper + upper * lower + lower * lower) - kPi * 16.0 * 4.0;
  double before = 0.0;
  for (const double radius : {1e3, 1e4, 1e5}) {
    const auto layout =
        lay({sunk(8.0, 18.0, 90.0)}, {.tube = {.outer_radius = radius, .wall = 4.0}}).value();
    const double off = std::abs(cone_of(layout).taken.volume - flat);
    if (before > 0.0) {
      EXPECT_NEAR(off / before, 0.1, 1e-2);
    }
    before = off;
  }
  EXPECT_LT(before, 0.03);
}

TEST(Countersink, ProvesItselfAndItsSectionsAddUpToItsVolume) {
  Sinks random(5);
  const auto rule = math::gauss_legendre(60);
  int landed = 0, whole = 0, mixed = 0;
  for (int i = 0; i < 60; ++i) {
    const auto one = drawn_cone(random);
    const Ground ground{.tube = one.tube, .kerf = one.kerf};
    const auto layout = lay({one.spec}, ground).value();
    for (const auto& check : verify(layout, ground))
      EXPECT_LE(check.value, check.limit) << check.name << " " << i;
    const auto& mould = cone_of(layout);
    const auto kind = cone_wall(mould.laying, *mould.cone);
    landed += kind == ConeWall::landed;
    whole += kind == ConeWall::whole;
    mixed += kind == ConeWall::mixed;
    const double hole = 0.5 * mould.cone->hole, most = 0.5 * mould.cone->diameter;
    const double bore = std::max(hole, cone_radius(mould.laying, *mould.cone, 0.0, false));
    std::vector<double> ends{0.0, hole, bore, most};
    // Where the cone meets its circle on a wall.
    const double met = one.tube.outer_radius - mould.cone->depth();
    for (const double rho : {one.tube.outer_radius, one.tube.inner_radius()}) {
      const double across = rho > std::abs(met) ? std::sqrt(rho * rho - met * met) : 0.0;
      if (across < hole) ends.push_back(std::sqrt(hole * hole - across * across));
    }
    std::ranges::sort(ends);
    double sum = 0.0;
    for (std::size_t k = 1; k < ends.size(); ++k)
      for (std::size_t g = 0; g < rule.nodes.size(); ++g) {
        const double turn = 0.5 * kPi * (1.0 + rule.nodes[g]), way = ends[k] - ends[k - 1];
        sum += 0.5 * kPi * rule.weights[g] * 0.5 * way * std::sin(turn) *
               cone_removed(mould.laying, *mould.cone,
                            ends[k - 1] + 0.5 * way * (1.0 - std::cos(turn)));
      }
    EXPECT_NEAR(2.0 * sum / mould.taken.volume, 1.0, 1e-8) << i;
  }
  EXPECT_GT(std::min({landed, whole, mixed}), 2) << landed << whole << mixed;
}

/// Each line of the torch runs beside the cone's line of its phase, half a kerf from it.
TEST(Countersink, TheBeamTouchesTheConeAlongItsLines) {
  Sinks random(6);
  for (int i = 0; i < 40; ++i) {
    const auto one = drawn_cone(random);
    const auto layout = lay({one.spec}, {.tube = one.tube, .kerf = one.kerf}).value();
    const auto& mould = cone_of(layout);
    const auto& rows = mould.rows;
    const double half = mould.cone->half, outer = one.tube.outer_radius;
    const Vector3d apex(outer - 0.5 * mould.cone->diameter / std::tan(half), 0.0, 0.0);
    for (std::size_t k = 0; k < rows.phi.size(); ++k) {
      const double w = kTwoPi * static_cast<double>(k) / static_cast<double>(rows.phi.size());
      const Vector3d along(std::cos(half), std::sin(half) * std::sin(w),
                           std::sin(half) * std::cos(w));
      const Vector3d from = math::cylinder_point(one.tube.inner_radius(), rows.torch_phi_inner[k],
                                                 rows.torch_z_inner[k]);
      const Vector3d to = math::cylinder_point(outer, rows.torch_phi[k], rows.torch_z[k]);
      EXPECT_LT((to - from).normalized().cross(along).norm(), 1e-9);
      EXPECT_NEAR((to - apex).cross(along).norm(), 0.5 * one.kerf, 1e-9);
      // B and a are the line's, seen from the normal at the torch's place.
      const double phi = rows.torch_phi[k];
      const Vector3d n(std::cos(phi), std::sin(phi), 0.0), t(-std::sin(phi), std::cos(phi), 0.0);
      EXPECT_NEAR(std::tan(rows.b[k]), along.z() / along.dot(n), 1e-9);
      EXPECT_NEAR(std::tan(rows.a[k]), along.dot(t) / along.dot(n), 1e-9);
    }
  }
}

TEST(Countersink, WithoutAKerfTheTorchIsOnTheEdgeAndAnotherAnchorMovesItOnly) {
  const joint::Target tube{.outer_radius = 44.45, .wall = 5.0};
  const auto spec = sunk(9.0, 16.0, 90.0);
  const auto first = lay({spec}, {.tube = tube}).value();
  const auto rows = placed(first, first.instances[1]);
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    EXPECT_NEAR(rows.torch_phi[i], rows.phi[i], 1e-12);
    EXPECT_NEAR(rows.torch_z[i], rows.z[i], 1e-12);
  }
  auto other = spec;
  other.at.phi += 1.3;
  other.at.z += 57.0;
  other.wall = Wall::through;  // the far side has no cone
  const auto moved = lay({other}, {.tube = tube}).value();
  ASSERT_EQ(moved.instances.size(), 3u);
  EXPECT_FALSE(moved.mould_of(moved.instances[2]).cone);
  const auto there = placed(moved, moved.instances[1]);
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    EXPECT_NEAR(there.phi[i] - rows.phi[i], 1.3, 1e-12);
    EXPECT_NEAR(there.z[i] - rows.z[i], 57.0, 1e-12);
  }
}

TEST(Countersink, IsRefusedAtItsOwnFields) {
  const joint::Target tube{.outer_radius = 44.45, .wall = 5.0};
  const auto refused = [&](const Spec& spec, double most_lean = 1.4) {
    const auto made =
        lay({spec}, {.tube = tube, .kerf = 1.5, .most_lean = most_lean, .most_swing = most_lean});
    if (made) return std::string("made");
    EXPECT_EQ(made.error().issues.size(), 1u);
    return made.error().issues.front().member;
  };
  EXPECT_EQ(refused(sunk(9.0, 16.0, 90.0)), "made");
  EXPECT_EQ(refused(sunk(9.0, 9.0, 90.0)), "cutouts/0/countersink/diameter");
  EXPECT_EQ(refused(sunk(2.0, 3.0, 130.0)), "cutouts/0/countersink/diameter");  // the beam: 3.55
  EXPECT_EQ(refused(sunk(9.0, 16.0, 90.0), 0.7), "cutouts/0/countersink/angle");
  EXPECT_EQ(refused(sunk(9.0, 16.0, 140.0)), "cutouts/0/countersink/angle");  // misses the bore
}

part::PartSpec plain(std::vector<Spec> cutouts) {
  part::PartSpec out{.target = {.outer_radius = 44.45, .wall = 5.0, .length = 400.0}};
  testing::make_ends_square(out);
  out.start.cut.target = out.finish.cut.target = out.target;
  out.cutouts.all = std::move(cutouts);
  out.cutouts.kerf = 1.5;
  return out;
}

TEST(Countersink, FollowsItsCircleAndTakesMetalOfThePart) {
  auto spec = sunk(9.0, 16.0, 90.0);
  spec.pattern = Linear{.count = 3, .pitch = 60.0};
  const auto asked = plain({spec});
  const auto made = part::part(asked).value();
  for (const auto& check : part::verify(asked, made))
    EXPECT_LE(check.value, check.limit) << check.name;
  std::vector<std::size_t> order;
  for (const auto& step : made.sequence)
    if (step.what == part::Step::What::cutout) order.push_back(step.index);
  EXPECT_EQ(order, (std::vector<std::size_t>{4, 5, 2, 3, 0, 1}));
  const double gone = part::part(plain({})).value().lengths.volume - made.lengths.volume;
  EXPECT_NEAR(gone, 3.0 * 508.13998, 3e-5);  // the golden volume of one
  // Webs are those of the cones.
  ASSERT_TRUE(made.cutout_report.between);
  EXPECT_NEAR(made.cutout_report.between->width, 60.0 - 16.0, 2e-3);
}

TEST(Countersink, WarnsOfASpentBeamAndOfOpenSides) {
  const auto codes = [](const Spec& spec) {
    std::vector<WarningCode> out;
    const auto made = part::part(plain({spec})).value();
    for (const auto& one : made.warnings) {
      EXPECT_EQ(one.member, "cutouts/0/countersink");
      out.push_back(one.code);
    }
    return out;
  };
  EXPECT_TRUE(codes(sunk(9.0, 16.0, 90.0)).empty());
  EXPECT_EQ(codes(sunk(4.0, 8.0, 120.0)), std::vector{WarningCode::spent_beam});
  EXPECT_EQ(codes(sunk(30.0, 31.0, 60.0)), std::vector{WarningCode::countersink_open});
}

}  // namespace
}  // namespace tubecut::testing
