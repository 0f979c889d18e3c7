#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "core/bevel/hole/hole.hpp"
#include "core/cutout/branch_hole.hpp"
#include "core/cutout/chain.hpp"
#include "core/cutout/cutout.hpp"
#include "core/part/section/section_part.hpp"
#include "core/part/square_holes.hpp"
#include "core/section/section.hpp"
#include "tests/core/cutout/square_ends.hpp"
#include "tests/core/section/golden_ends.hpp"

/// Holes for branches that reach over corners: the branch point by point in the wall, by distances
/// alone; a round tube; the same joint drawn in another way.
namespace tubecut::testing::branch_corners {
namespace {

using namespace cutout;
using Eigen::Vector2d;
using Eigen::Vector3d;
using joint::JointKind;
using Random = std::mt19937;

constexpr double kFit = 3e-4;  // mm: of arcs for the outline, and its own margin

/// Signed, of a rectangle with round corners.
double distance_to(double height, double width, double radius, const Vector2d& p) {
  const Vector2d q = p.cwiseAbs() - Vector2d(0.5 * height - radius, 0.5 * width - radius);
  return q.cwiseMax(0.0).norm() + std::min(std::max(q.x(), q.y()), 0.0) - radius;
}

/// The distance of a place from the surface that the hole follows: the branch's outside, or its
/// bore if it is set on.
double off_branch(const Branch& branch, const Vector3d& place) {
  const Vector3d d = branch.axis.direction.normalized();
  const Vector3d p = place - branch.axis.point;
  const double in = branch.kind == JointKind::set_on ? 1.0 : 0.0;
  if (!branch.section) return (p - p.dot(d) * d).norm() - branch.radius + in * branch.wall;
  const auto& s = *branch.section;
  const Vector3d x = (branch.up - branch.up.dot(d) * d).normalized(), y = d.cross(x);
  return distance_to(s.height - 2 * in * s.wall, s.width - 2 * in * s.wall,
                     in > 0.0 ? s.inner_corner : s.corner, {p.dot(x), p.dot(y)});
}

/// The line of the wall at s, from the outside on, by the section's distances.
struct Line {
  Vector2d outer, bore, normal;
};
Line line_at(const section::Section& section, double s) {
  const auto at = section.outer().at(s);
  double low = 0.0, high = 2.0 * section.wall;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const Vector2d p = at.point - middle * at.normal;
    const double off = distance_to(section.height - 2 * section.wall,
                                   section.width - 2 * section.wall, section.inner_corner, p);
    (off > 0.0 ? low : high) = middle;
  }
  return {at.point, at.point - low * at.normal, at.normal};
}

/// A hole on the developed outside: s and z of its anchor, and its chain about it.
struct Laid {
  double s = 0.0, z = 0.0;
  Chain chain;
};
Laid laid(const section::Section& section, const BranchHole& hole) {
  const auto& at = hole.spec.at;
  return {section.outer().on_face(at.face, at.offset), at.z, chain_of(hole.spec).value()};
}

/// The least distance of a line of the wall from the branch, and the greatest one.
std::pair<double, double> gaps(const section::Section& section, const Branch& branch, double s,
                               double z) {
  const auto line = line_at(section, s);
  const auto off = [&](double depth) {
    const Vector2d p = line.outer + depth * (line.bore - line.outer);
    return off_branch(branch, {p.x(), p.y(), z});
  };
  double low = 0.0, high = 1.0;  // it is convex
  for (int i = 0; i < 80; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (off(a) < off(b) ? high : low) = off(a) < off(b) ? b : a;
  }
  return {off(0.5 * (low + high)), std::max(off(0.0), off(1.0))};
}

/// The hole is as large as the branch with its gap requires of a wall square to the outside.
void expect_fits(const section::Section& section, const Branch& branch, const BranchHole& hole,
                 Random& random, const std::string& label) {
  const auto [s0, z0, chain] = laid(section, hole);
  const bool on = branch.kind == JointKind::set_on;
  double least = 1e9, most = -1e9, widest = 0.0;
  for (const auto& segment : chain)
    for (const double share : {0.0, 0.3, 0.7}) {
      const Flat p = segment.at(share);
      const auto [near, far] = gaps(section, branch, s0 + p.y(), z0 + p.x());
      const auto outer = line_at(section, s0 + p.y()).outer;
      const double off = on ? off_branch(branch, {outer.x(), outer.y(), z0 + p.x()}) : near;
      least = std::min(least, off);
      most = std::max(most, off);
      widest = std::max(widest, far);
    }
  const double gap = on ? 0.0 : branch.gap;
  EXPECT_GT(least, gap - kFit) << label;
  EXPECT_LT(most, gap + kFit) << label;
  if (!on) {
    EXPECT_NEAR(widest, hole.greatest_gap, 0.02) << label;
    EXPECT_LT(widest, hole.greatest_gap + 1e-3) << label;
  }
  const auto box = bounds(chain);
  for (int i = 0; i < 400; ++i) {
    const Flat p(between(random, box.least.x() - 5.0, box.most.x() + 5.0),
                 between(random, box.least.y() - 5.0, box.most.y() + 5.0));
    const auto line = line_at(section, s0 + p.y());
    const double depth = on ? 0.0 : between(random, 0.0, 1.0);
    const Vector2d q = line.outer + depth * (line.bore - line.outer);
    if (q.dot(branch.axis.direction.head<2>()) < 0.0) continue;
    const double off = off_branch(branch, {q.x(), q.y(), z0 + p.x()});
    if (off < gap - kFit) {
      EXPECT_TRUE(holds(chain, p)) << label << " " << p.transpose();
    } else if (on && off > kFit) {
      EXPECT_FALSE(holds(chain, p)) << label << " " << p.transpose();
    }
  }
}

/// A branch that is about as wide as the section's flat, in any direction.
Branch drawn_branch(Random& random, const section::Section& section, int face, int lean) {
  const bool odd = face % 2 == 1;
  const double side = odd ? section.width : section.height;  // across the face
  Branch out{.wall = between(random, 2.0, 4.0), .gap = between(random, 0.0, 1.0)};
  const double width = between(random, 0.8, 1.0) * (side - 2.0 * section.wall);
  out.radius = 0.5 * width;
  out.kind = static_cast<JointKind>(random() % 2);
  if (random() % 2 == 0)
    out.section = section::Section{width, between(random, 0.6, 1.0) * width, out.wall,
                                   2.0 * out.wall, out.wall};
  const auto n2 = section::Curve::face_normal(face);
  const Vector3d n(n2.x(), n2.y(), 0), t(-n2.y(), n2.x(), 0);
  const double along = lean > 0 ? between(random, -1.0, 1.0) : 0.0;
  const double across = lean > 1 ? between(random, -0.5, 0.5) : 0.0;
  out.axis = {Vector3d(0, 0, 200.0) + between(random, -2.0, 2.0) * t,
              n + along * Vector3d::UnitZ() + across * t};
  out.up = random() % 2 == 0 ? Vector3d::UnitZ().eval()
                             : Vector3d(between(random, -1, 1), between(random, -1, 1), 1.0);
  return out;
}

TEST(BranchCorners, AreWhatTheBranchRequiresOfASquareWall) {
  Random random(31);
  int over = 0, open = 0;
  for (int i = 0; i < 240; ++i) {
    const auto section = drawn_section(random, 160, 2.5);
    const section::Wall wall(section);
    const int face = static_cast<int>(random() % 4) + 1;
    const auto branch = drawn_branch(random, section, face, i % 3);
    const auto label = std::to_string(i) + (branch.section ? " square" : " round") +
                       (branch.kind == JointKind::set_on ? " on" : " in");
    const auto holes = holes_for(branch, "h", {}, &wall, {});
    if (!holes) {
      EXPECT_EQ(holes.error().code(), ErrorCode::open_profile)
          << label << holes.error().issues.front().hint;
      ++open;
      continue;
    }
    if (holes->front().spec.wall != Wall::developed) continue;
    ++over;
    expect_fits(section, branch, holes->front(), random, label);
  }
  std::cout << over << " over corners, " << open << " open\n";
  EXPECT_GE(over, 100);
}

part::SectionPartSpec part_with(const section::Section& section, const Branch& branch,
                                double kerf) {
  part::SectionPartSpec out{.section = section, .length = 600.0};
  testing::make_ends_square(out);
  out.cutouts.kerf = kerf;
  const auto added =
      part::add_square_holes({{.branch = branch, .name = "h"}}, {}, section, {}, out.cutouts);
  EXPECT_TRUE(added);
  return out;
}

TEST(BranchCorners, PassTheChecksOfTheirPart) {
  Random random(32);
  int over = 0, tight = 0;
  for (int i = 0; i < 90; ++i) {
    const auto section = drawn_section(random, 160, 2.5);
    const section::Wall wall(section);
    const int face = static_cast<int>(random() % 4) + 1;
    const auto branch = drawn_branch(random, section, face, i % 3);
    const auto holes = holes_for(branch, "h", {}, &wall, {});
    if (!holes || holes->front().spec.wall != Wall::developed) continue;
    const auto spec = part_with(section, branch, 0.2);
    const auto made = part::section_part(spec);
    const auto label = std::to_string(i) + (branch.section ? " square" : " round") +
                       (branch.kind == JointKind::set_on ? " on" : " in");
    if (!made) {
      ++tight;
      std::cout << label << " " << made.error().issues.front().member << " "
                << made.error().issues.front().hint << "\n";
      continue;
    }
    ++over;
    for (const auto& check : part::verify(spec, *made))
      EXPECT_LE(check.value, check.limit) << check.name << " of " << label;
    EXPECT_NE(made->cutouts.moulds.front().laying.over(), nullptr) << label;
  }
  std::cout << over << " parts, " << tight << " refused\n";
  EXPECT_GT(over, 25);
  EXPECT_LT(tight, 3);
}

/// The beam opens the hole down to the bore: the finished edge there is within half a kerf of an
/// axis, except for metal that the straight ways between rows and hollows at seams leave.
TEST(BranchCorners, AreOpenedByTheBeam) {
  constexpr double kLeft = 0.02;  // mm
  constexpr int kBetween = 8;     // beams from row to row
  const double kerf = 0.3;
  Random random(36);
  int seen = 0;
  for (int i = 0; i < 60; ++i) {
    const auto section = drawn_section(random, 160, 2.5);
    const section::Wall wall(section);
    auto branch = drawn_branch(random, section, static_cast<int>(random() % 4) + 1, i % 3);
    branch.kind = JointKind::set_in;
    const auto holes = holes_for(branch, "h", {}, &wall, {});
    if (!holes || holes->front().spec.wall != Wall::developed) continue;
    const auto made =
        lay({holes->front().spec}, {.tube = {.wall = section.wall}, .section = wall, .kerf = kerf});
    if (!made) continue;
    ++seen;
    const auto rows = placed(*made, made->instances.front());
    std::vector<std::pair<Vector3d, Vector3d>> beams;
    for (std::size_t k = 0; k < rows.phi.size(); ++k)
      for (int part = 0; part < kBetween; ++part) {
        const double share = part / double{kBetween};
        const auto next = (k + 1) % rows.phi.size();
        const double phi = (1 - share) * rows.torch_phi[k] + share * rows.torch_phi[next];
        const double z = (1 - share) * rows.torch_z[k] + share * rows.torch_z[next];
        const auto at = section.outer().at(phi / kTwoPi * section.outer().girth());
        beams.emplace_back(Vector3d(at.point.x(), at.point.y(), z),
                           Vector3d(at.normal.x(), at.normal.y(), 0.0));
      }
    const auto [s0, z0, chain] = laid(section, holes->front());
    double left = 0.0;
    for (const auto& segment : chain)
      for (const double share : {0.0, 0.25, 0.5, 0.75}) {
        const Flat p = segment.at(share);
        const auto bore = line_at(section, s0 + p.y()).bore;
        const Vector3d edge(bore.x(), bore.y(), z0 + p.x());
        double nearest = 1e9;
        for (const auto& [point, along] : beams)
          nearest = std::min(nearest, (edge - point).cross(along).norm());
        left = std::max(left, nearest - 0.5 * kerf);
      }
    EXPECT_LT(left, kLeft) << i;
  }
  EXPECT_GT(seen, 10);
}

/// A section whose corners have half its side is round.
section::Section round_section(double radius, double wall) {
  return {2.0 * radius, 2.0 * radius, wall, radius, radius - wall};
}

/// The edges of a round branch's hole in a round tube, by the program for both round, lie on the
/// hole's chain, if the tube is such a section, or if the branch is.
TEST(BranchCorners, BetweenRoundTubesAreThoseOfThem) {
  Random random(33);
  int made = 0;
  for (int i = 0; i < 30; ++i) {
    const double radius = between(random, 40.0, 60.0), wall = between(random, 2.0, 6.0);
    const joint::Target tube{.outer_radius = radius, .wall = wall};
    Branch branch{.radius = between(random, 10.0, 0.6 * radius),
                  .wall = 2.0,
                  .kind = static_cast<JointKind>(i % 2),
                  .gap = between(random, 0.0, 1.0)};
    const double side = between(random, 0.2, 6.0);
    const Vector3d n(std::cos(side), std::sin(side), 0.0);
    branch.axis = {Vector3d(0, 0, 100.0) + between(random, -2.0, 2.0) * n.cross(Vector3d::UnitZ()),
                   (n + between(random, -1.0, 1.0) * Vector3d::UnitZ()).normalized()};
    bevel::HoleSpec spec{.chord = tube,
                         .branch = joint::AxisTube{branch.radius, branch.axis},
                         .branch_wall = branch.wall,
                         .kind = branch.kind,
                         .gap = branch.kind == JointKind::set_on ? 0.0 : branch.gap,
                         .tilt = bevel::Tilt::none};
    spec.groove = bevel::SquareCut{};
    spec.sampling.uniform_points = 90;
    const auto wanted = bevel::hole(spec);
    if (!wanted) continue;
    ++made;
    auto other = branch;
    other.section = round_section(branch.radius, branch.wall);
    const section::Wall section(round_section(radius, wall));
    const auto& edge = wanted->holes.front();
    for (const bool on_section : {true, false}) {
      const auto holes = on_section ? holes_for(branch, "h", {}, &section, {})
                                    : holes_for(other, "h", tube, nullptr, Angle::rad(0.3));
      ASSERT_TRUE(holes);
      const auto& hole = holes->front();
      ASSERT_EQ(hole.spec.wall, Wall::developed);
      const auto chain = chain_of(hole.spec).value();
      const double s = on_section ? section.outer().on_face(hole.spec.at.face, hole.spec.at.offset)
                                  : radius * (hole.spec.at.phi + 0.3);
      for (std::size_t k = 0; k < edge.phi.size(); ++k) {
        const double b = radius * std::remainder(edge.phi[k] - s / radius, kTwoPi);
        EXPECT_LT(distance(chain, {edge.z[k] - hole.spec.at.z, b}), kFit) << i << " " << k;
      }
    }
  }
  EXPECT_GT(made, 20);
}

/// A square branch that leans in a round tube.
TEST(BranchCorners, OfSquareBranchesInRoundTubesAreWhatTheyRequire) {
  Random random(34);
  int made = 0;
  for (int i = 0; i < 40; ++i) {
    const double radius = between(random, 40.0, 60.0), wall = between(random, 2.0, 6.0);
    const auto round = round_section(radius, wall);
    auto branch = drawn_branch(random, round, static_cast<int>(random() % 4) + 1, 2);
    const double width = between(random, 0.5, 1.2) * radius;
    branch.section = section::Section{width, 0.8 * width, 3.0, 6.0, 3.0};
    const auto holes =
        holes_for(branch, "h", {.outer_radius = radius, .wall = wall}, nullptr, Angle::rad(0.3));
    if (!holes) continue;
    ++made;
    auto hole = holes->front();  // seen on the section that is round
    const auto place = round.outer().at(radius * (hole.spec.at.phi + 0.3));
    hole.spec.at.face = place.face;
    hole.spec.at.offset = place.on_corner ? radius * place.along : 0.0;
    expect_fits(round, branch, hole, random, std::to_string(i));
  }
  EXPECT_GT(made, 30);
}

TEST(BranchCorners, PassThroughBothSides) {
  Random random(35);
  int over = 0;
  for (int i = 0; i < 40; ++i) {
    const auto section = drawn_section(random, 100, 2.5);
    const section::Wall wall(section);
    auto branch = drawn_branch(random, section, static_cast<int>(random() % 4) + 1, i % 3);
    branch.kind = JointKind::through;
    const auto holes = holes_for(branch, "h", {}, &wall, {});
    if (!holes) continue;
    ASSERT_EQ(holes->size(), 2U);
    for (const bool far : {false, true}) {
      const auto& hole = (*holes)[far ? 1 : 0];
      if (hole.spec.wall != Wall::developed) continue;
      ++over;
      auto one = branch;
      if (far) one.axis.direction = -one.axis.direction;
      expect_fits(section, one, hole, random, std::to_string(i));
    }
  }
  EXPECT_GT(over, 20);
}

/// Area, volume and greatest gap of the hole in a part.
Eigen::Array3d figures(const section::Section& section, const Branch& branch) {
  const section::Wall wall(section);
  const auto holes = holes_for(branch, "h", {}, &wall, {}).value();
  const auto made = lay({holes.front().spec}, {.tube = {.wall = section.wall}, .section = wall});
  EXPECT_TRUE(made);
  const auto& taken = made->moulds.front().taken;
  return {taken.outer_area, taken.volume, holes.front().greatest_gap};
}

TEST(BranchCorners, AreTheSameWhereTheJointIsTurnedOrMirrored) {
  const section::Section section{60.0, 60.0, 4.0, 8.0, 4.0};
  for (const bool square : {false, true})
    for (const auto kind : {JointKind::set_on, JointKind::set_in}) {
      Branch branch{.radius = 25.0, .wall = 2.5, .kind = kind, .gap = 0.3};
      if (square) branch.section = section::Section{50.0, 40.0, 3.0, 6.0, 3.0};
      branch.up = Vector3d(0.1, 0.3, 1.0);
      branch.axis = {{0, 0.4, 100.0}, {1.0, 0.1, 0.6}};
      const auto one = figures(section, branch);
      for (int quarter = 1; quarter < 4; ++quarter) {
        auto other = branch;
        const Eigen::AngleAxisd turn(0.5 * kPi * quarter, Vector3d::UnitZ());
        for (auto* v : {&other.axis.point, &other.axis.direction, &other.up}) *v = turn * *v;
        EXPECT_LT((figures(section, other) / one - 1.0).abs().maxCoeff(), 1e-5);
      }
      auto other = branch;
      for (auto* v : {&other.axis.point, &other.axis.direction, &other.up}) v->y() = -v->y();
      EXPECT_LT((figures(section, other) / one - 1.0).abs().maxCoeff(), 1e-5);
      for (auto* v : {&other.axis.point, &other.axis.direction, &other.up}) v->z() = -v->z();
      EXPECT_LT((figures(section, other) / one - 1.0).abs().maxCoeff(), 1e-5);
    }
}

/// The hole of a branch that just leaves its flat is that of one that just does not.
TEST(BranchCorners, BeginAsThoseOnAFlat) {
  const section::Section section{100.0, 80.0, 4.0, 8.0, 4.0};  // face 1 is flat for 64 mm
  for (const double lean : {0.0, 0.5, -1.0})
    for (const auto kind : {JointKind::set_in, JointKind::set_on}) {
      if (kind == JointKind::set_on && lean != 0.0)
        continue;  // on a flat it clears the bore's wall
      const double half = kind == JointKind::set_on ? 34.0 : 31.5;
      Branch branch{.radius = half, .wall = 2.0, .kind = kind, .gap = 0.5};
      branch.axis = {{0, -1e-3, 200.0}, {1.0, 0.0, lean}};
      auto other = branch;
      other.radius -= 2e-3;
      other.gap = branch.gap;
      const section::Wall wall(section);
      ASSERT_FALSE(holes_for(branch, "h", {}, &wall, {})->front().spec.on_one_flat);
      ASSERT_TRUE(holes_for(other, "h", {}, &wall, {})->front().spec.on_one_flat);
      EXPECT_LT((figures(section, branch) / figures(section, other) - 1.0).abs().maxCoeff(), 5e-3)
          << lean;
    }
}

/// A branch as wide as its chord, as gates have it: the hole is the branch's bore on the outside,
/// which lies on the corners beyond the flat.
TEST(BranchCorners, OfBranchesAsWideAsTheChordHaveClosedForms) {
  const section::Section chord{60.0, 60.0, 4.0, 8.0, 4.0};
  Branch branch{.radius = 30.15, .wall = 3.2, .kind = JointKind::set_on};
  branch.axis = {{0, 0, 100.0}, {1.0, 0.0, 0.0}};
  const section::Wall wall(chord);
  const auto bore = 30.15 - 3.2;  // the flat is 44 wide
  const auto box = bounds(chain_of(holes_for(branch, "h", {}, &wall, {})->front().spec).value());
  const double round = 22.0 + 8.0 * std::asin((bore - 22.0) / 8.0);
  EXPECT_NEAR(box.most.y(), round, 1e-4);
  EXPECT_NEAR(box.least.y(), -round, 1e-4);
  EXPECT_NEAR(box.most.x(), bore, 1e-4);
  branch.section = section::Section{60.0, 60.0, 4.0, 8.0, 4.0};
  branch.up = Vector3d::UnitZ();
  const auto square = bounds(chain_of(holes_for(branch, "h", {}, &wall, {})->front().spec).value());
  EXPECT_NEAR(square.most.y(), 22.0 + 8.0 * std::asin(4.0 / 8.0), 1e-4);
  EXPECT_NEAR(square.most.x(), 26.0, 1e-4);
  branch.kind = JointKind::set_in;  // its sides are the chord's
  const auto refused = holes_for(branch, "h", {}, &wall, {});
  EXPECT_TRUE(!refused || !lay({refused->front().spec}, {.tube = {.wall = 4.0}, .section = wall}));
}

}  // namespace
}  // namespace tubecut::testing::branch_corners
