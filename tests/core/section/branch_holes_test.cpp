#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/cutout/branch_hole.hpp"
#include "core/cutout/chain.hpp"
#include "core/math/rotation.hpp"
#include "tests/core/section/golden_ends.hpp"

/// Holes for branches, in a flat or in a round tube: an independent program, the branch's own
/// surface point by point, and closed forms.
namespace tubecut::testing::branch_holes {

using namespace cutout;
using api::Json;
using Eigen::Vector2d;
using Eigen::Vector3d;
using joint::JointKind;
using Random = std::mt19937;

constexpr int kPlaces = 360;       // of a branch's outline
constexpr double kOutline = 3e-4;  // mm: that of arcs for ellipses, and the outline's own margin

/// A place in the local plane of the hole's anchor: along z, and round the tube.
Flat local(const section::Wall& wall, const Spec& spec, const Vector3d& p) {
  const auto n = section::Curve::face_normal(spec.at.face);
  EXPECT_GT(wall.outer().face_distance(spec.at.face), 0.0);
  return {p.z() - spec.at.z, Vector2d(-n.y(), n.x()).dot(p.head<2>()) - spec.at.offset};
}

/// How far the place lies outside the hole, mm.
double outside(const Chain& chain, const Flat& p) {
  return holds(chain, p) ? 0.0 : distance(chain, p);
}

TEST(BranchHoles, InAFlatHoldTheCurvesOfAnIndependentProgram) {
  const auto all = golden("sections.json");
  int made = 0;
  for (const auto& one : *at(all, "holes").as<Json::Array>()) {
    const auto name = text(one, "name");
    if (name == "rhs_into_round" || name == "round_over_corner") continue;
    ++made;
    const section::Wall wall(golden_section(at(one, "chord")));
    const auto size = golden_section(at(one, "branch"));
    Branch branch{.radius = 0.5 * size.height, .wall = size.wall, .gap = number(one, "gap")};
    if (name == "shs_into_flat") branch.section = size;
    branch.axis = {golden_vector(one, "point"), golden_vector(one, "direction")};
    branch.up = golden_vector(one, "branch_x");
    const auto holes = holes_for(branch, "h", {}, &wall, {});
    ASSERT_TRUE(holes);
    const auto& spec = holes->front().spec;
    const auto chain = chain_of(spec).value();
    const auto column = [&](const char* which) { return golden_column(at(one, "rows"), which); };
    const auto xo = column("x_outside"), yo = column("y_outside"), zo = column("z_outside");
    const auto xi = column("x_bore"), yi = column("y_bore"), zi = column("z_bore");
    for (std::size_t i = 0; i < xo.size(); ++i) {
      const auto outer = local(wall, spec, {xo[i], yo[i], zo[i]});
      const auto inner = local(wall, spec, {xi[i], yi[i], zi[i]});
      EXPECT_LT(outside(chain, outer), 1e-6) << name << i;
      EXPECT_LT(outside(chain, inner), 1e-6) << name << i;
      // A convex outline moved along a line: one of the two is on the hull.
      EXPECT_LT(std::min(distance(chain, outer), distance(chain, inner)), kOutline) << name << i;
    }
  }
  EXPECT_EQ(made, 3);
}

section::Section drawn_section(Random& random, double least, double most) {
  const double wall = between(random, 2.0, least > 50.0 ? 5.0 : 3.0);
  const auto radii = section::corner_radii(static_cast<section::Standard>(random() % 3), wall);
  return {between(random, least, most), between(random, least, most), wall, radii.outer,
          radii.inner};
}

Branch drawn_branch(Random& random) {
  Branch out{.radius = between(random, 8.0, 20.0), .wall = 2.0, .gap = between(random, 0.0, 1.0)};
  if (random() % 3 != 0) out.section = drawn_section(random, 16.0, 40.0);
  if (random() % 3 == 0 && out.section) {
    auto& s = *out.section;
    s.corner = 0.5 * std::min(s.height, s.width);
    s.inner_corner = s.corner - s.wall;
  }
  if (random() % 4 == 0) out.kind = JointKind::through;
  return out;
}

/// Places of the branch's surface, grown by its gap, about its axis point: `k` round it, at `way`
/// along it.
std::vector<Vector2d> grown_outline(const Branch& branch) {
  std::vector<Vector2d> out;
  const auto& s = branch.section;
  const double r = (s ? s->corner : branch.radius) + branch.gap;
  const Vector2d half =
      s ? Vector2d(0.5 * s->height - s->corner, 0.5 * s->width - s->corner) : Vector2d(0, 0);
  for (int k = 0; k < kPlaces; ++k) {
    const double phi = kTwoPi * k / kPlaces;
    const Vector2d n(std::cos(phi), std::sin(phi));
    const Vector2d corner(std::copysign(half.x(), n.x()), std::copysign(half.y(), n.y()));
    out.push_back(corner + r * n);
  }
  return out;
}

TEST(BranchHoles, InAFlatAreTheHullOfTheBranchBetweenBothSurfaces) {
  Random random(5);
  int on_flats = 0;
  for (int drawing = 0; drawing < 60; ++drawing) {
    const section::Wall wall(drawn_section(random, 60.0, 200.0));
    auto branch = drawn_branch(random);
    const int face = static_cast<int>(random() % 4) + 1;
    const auto n2 = section::Curve::face_normal(face);
    const Vector3d n(n2.x(), n2.y(), 0), t(-n2.y(), n2.x(), 0);
    const bool square = drawing % 4 == 0;
    const Vector3d direction = n + (square ? 0.0 : between(random, -0.8, 0.8)) * Vector3d::UnitZ() +
                               (square ? 0.0 : between(random, -0.2, 0.2)) * t;
    branch.axis = {Vector3d(0, 0, 200.0) + between(random, -5.0, 5.0) * t, direction};
    branch.up = Vector3d(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
    const auto holes = holes_for(branch, "h", {}, &wall, {});
    ASSERT_TRUE(holes) << drawing;
    ASSERT_EQ(holes->size(), branch.kind == JointKind::through ? 2U : 1U);
    for (const auto& hole : *holes) {
      const auto& spec = hole.spec;
      if (!spec.on_one_flat) continue;
      ++on_flats;
      const auto chain = chain_of(spec).value();
      const auto m2 = section::Curve::face_normal(spec.at.face);
      const Vector3d m(m2.x(), m2.y(), 0.0), d = branch.axis.direction.normalized();
      const Vector3d x = (branch.up - branch.up.dot(d) * d).normalized(), y = d.cross(x);
      std::vector<Flat> touched;
      for (const auto& p : grown_outline(branch))
        for (const double depth : {0.0, 0.5 * wall.section().wall, wall.section().wall}) {
          const Vector3d from = branch.axis.point + p.x() * x + p.y() * y;
          const double plane = wall.outer().face_distance(spec.at.face) - depth;
          touched.push_back(local(wall, spec, from + (plane - m.dot(from)) / m.dot(d) * d));
          EXPECT_LT(outside(chain, touched.back()), 1e-6) << drawing;
        }
      // As wide as the branch requires, in every direction.
      for (int k = 0; k < 45; ++k) {
        const Flat u(std::cos(kTwoPi * k / 45), std::sin(kTwoPi * k / 45));
        double needs = -1e9, has = -1e9;
        for (const auto& p : touched) needs = std::max(needs, u.dot(p));
        for (const auto& s : chain)
          for (int i = 0; i <= 256; ++i) has = std::max(has, u.dot(s.at(i / 256.0)));
        EXPECT_GT(has, needs - 4e-3) << drawing;  // of both samples
        EXPECT_LT(has, needs + 4e-3) << drawing;
      }
      EXPECT_GE(hole.greatest_gap, branch.gap);
      if (square) {
        EXPECT_NEAR(hole.greatest_gap, branch.gap, 1e-9);
      }
    }
  }
  EXPECT_GT(on_flats, 60);
}

TEST(BranchHoles, AtARightAngleHaveClosedForms) {
  const section::Wall wall({100, 80, 4, 8, 4});
  Branch branch{.radius = 12.0, .wall = 2.0, .gap = 0.5};
  branch.axis = {{0, 3, 50}, {1, 0, 0}};
  const auto round = holes_for(branch, "h", {}, &wall, {}).value().front().spec;
  EXPECT_DOUBLE_EQ(std::get<Circle>(round.shape).diameter, 25.0);
  EXPECT_EQ(round.at.face, 1);
  EXPECT_DOUBLE_EQ(round.at.offset, 3.0);
  EXPECT_DOUBLE_EQ(round.at.z, 50.0);
  branch.section = section::Section{30, 20, 2, 4, 2};
  branch.up = {0, 0, 1};
  branch.kind = JointKind::through;
  const auto both = holes_for(branch, "h", {}, &wall, {}).value();
  for (const auto& hole : both) {
    const auto& shape = std::get<Rectangle>(hole.spec.shape);
    EXPECT_DOUBLE_EQ(shape.along, 31.0);
    EXPECT_DOUBLE_EQ(shape.round, 21.0);
    EXPECT_DOUBLE_EQ(shape.radius, 4.5);
    EXPECT_NEAR(hole.spec.turn, 0.0, 1e-12);
  }
  EXPECT_EQ(both[1].spec.at.face, 3);
  EXPECT_DOUBLE_EQ(both[1].spec.at.offset, -3.0);
  branch.kind = JointKind::set_on;  // its bore
  const auto on = std::get<Rectangle>(holes_for(branch, "h", {}, &wall, {})->front().spec.shape);
  EXPECT_DOUBLE_EQ(on.along, 26.0);
  EXPECT_DOUBLE_EQ(on.radius, 2.0);
}

/// The branch passes: its surface within the wall of a round tube lies in the hole, whose wall is
/// square to the tube from its edge on the bore on.
TEST(BranchHoles, InARoundTubeLetTheBranchPass) {
  Random random(8);
  double widest = 0.0;
  for (int drawing = 0; drawing < 100; ++drawing) {
    const joint::Target tube{.outer_radius = between(random, 40.0, 60.0),
                             .wall = between(random, 2.0, 8.0)};
    auto branch = drawn_branch(random);
    branch.section = drawn_section(random, 16.0, 40.0);
    const double side = between(random, 0.0, kTwoPi);
    const Vector3d d(std::cos(side), std::sin(side), 0.0), t(-d.y(), d.x(), 0.0);
    branch.axis = {Vector3d(0, 0, 100.0) + between(random, -6.0, 6.0) * t, d};
    branch.up = Vector3d(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
    const auto holes = holes_for(branch, "h", tube, nullptr, Angle::rad(0.3));
    ASSERT_TRUE(holes) << drawing;
    const auto& hole = holes->front();
    const auto chain = chain_of(hole.spec).value();
    const Vector3d x = (branch.up - branch.up.dot(d) * d).normalized(), y = d.cross(x);
    const double r = tube.inner_radius();
    for (const auto& p : grown_outline(branch))
      for (const double rho : {r, 0.5 * (r + tube.outer_radius), tube.outer_radius}) {
        const Vector3d at = branch.axis.point + p.x() * x + p.y() * y;
        const double b = at.dot(t);
        const Vector3d place = at + (std::sqrt(rho * rho - b * b) - at.dot(d)) * d;
        const double phi = std::atan2(place.y(), place.x()) - 0.3 - hole.spec.at.phi;
        EXPECT_LT(outside(chain, {place.z() - hole.spec.at.z, r * std::sin(phi)}), 2e-5) << drawing;
      }
    EXPECT_GE(hole.greatest_gap, branch.gap);
    widest = std::max(widest, hole.greatest_gap - branch.gap);
  }
  EXPECT_LT(widest, 12.0);
}

TEST(BranchHoles, AreRefusedWhereNoSquareWallFits) {
  const section::Wall wall({100, 80, 4, 8, 4});
  Branch branch{.radius = 12.0, .wall = 2.0};
  branch.axis = {{0, 0, 50}, {0, 0, 1}};
  EXPECT_EQ(holes_for(branch, "h", {}, &wall, {}).error().code(), ErrorCode::parallel_axes);
  branch.axis = {{0, 45, 50}, {1, 0, 0}};
  EXPECT_EQ(holes_for(branch, "h", {}, &wall, {}).error().code(), ErrorCode::open_profile);
  branch.axis = {{0, 0, 50}, {1, 0, 0}};
  branch.radius = 37.0;  // beyond the bore
  const auto wide = holes_for(branch, "h", {}, &wall, {});
  EXPECT_TRUE(!wide || !lay({wide->front().spec}, {.tube = {.wall = 4.0}, .section = wall}));
}

}  // namespace tubecut::testing::branch_holes
