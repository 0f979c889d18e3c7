#include "core/bevel/table/required.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/bevel/table/angles.hpp"
#include "core/joint/contour.hpp"
#include "tests/core/joint/published.hpp"
#include "tests/core/joint/random_nodes.hpp"

namespace tubecut::bevel {
namespace {

using testing::numbers;

struct Inner {
  joint::Contour contour;
  Wall wall;

  double required(double phi) const {
    return required_bevel(contour.cutters, wall, joint::generator_at(wall.inner, phi),
                          joint::contact_at(contour, phi).z);
  }
  double rule(double phi) const {
    const auto line = joint::generator_at(wall.inner, phi);
    const auto& cutter = contour.cutters[joint::contact_at(contour, phi).cutter];
    return Rule(HalfDihedral{}, Dihedral::weld_side).angles(joint::hit(cutter, line)->normal).b;
  }
};

double radians(std::size_t degree) { return Angle::deg(static_cast<double>(degree)).rad(); }

TEST(Required, Table1) {
  const auto golden = testing::golden(joint::kGolden);
  const std::string block = "seed000_table1_wall/";
  const Inner inner{*joint::trace(joint::table1(), 30), {30, 35}};
  const auto b_rule = numbers(golden, block + "B_rule");
  const auto b_req = numbers(golden, block + "B_req");
  const auto floor = numbers(golden, block + "floor");
  const auto z_out = numbers(golden, block + "z_out");
  const auto square_z = numbers(golden, block + "square_cut_auto_z");
  const auto clearance = numbers(golden, block + "clearance_inner_rule");
  ASSERT_EQ(b_req.size(), 360U);
  int above_rule = 0;
  for (std::size_t i = 0; i < b_req.size(); ++i) {
    const double phi = radians(i);
    const double rule = inner.rule(phi);
    const double required = inner.required(phi);
    const double higher = std::max(rule, required);
    EXPECT_NEAR(rule * kDegPerRad, b_rule[i], 1e-9) << i;
    EXPECT_NEAR(required * kDegPerRad, b_req[i], 1e-9) << i;
    EXPECT_NEAR(higher * kDegPerRad, floor[i], 1e-9) << i;
    const double z_in = joint::contact_at(inner.contour, phi).z;
    EXPECT_NEAR(z_in + 5.0 * std::tan(higher), z_out[i], 1e-9) << i;
    const auto line = joint::generator_at(30, phi);
    EXPECT_NEAR(lift(inner.contour.cutters, inner.wall, line, 0.0), square_z[i], 1e-10) << i;
    EXPECT_NEAR(z_in - lift(inner.contour.cutters, inner.wall, line, std::tan(rule)), clearance[i],
                1e-9)
        << i;
    above_rule += required > rule ? 1 : 0;
  }
  EXPECT_EQ(above_rule, 1);
}

TEST(Required, Eccentric) {
  const auto golden = testing::golden(joint::kGolden);
  const Inner inner{*joint::trace(joint::eccentric_cutters(golden), 54), {54, 60}};
  const auto b_rule = numbers(golden, "eccentric/wall/B_rule");
  const auto b_req = numbers(golden, "eccentric/wall/B_req");
  const auto clearance = numbers(golden, "eccentric/wall/clearance");
  ASSERT_EQ(b_req.size(), 360U);
  for (std::size_t i = 0; i < b_req.size(); ++i) {
    const double phi = radians(i);
    const double rule = inner.rule(phi);
    EXPECT_NEAR(rule * kDegPerRad, b_rule[i], 1e-9) << i;
    EXPECT_NEAR(inner.required(phi) * kDegPerRad, b_req[i], 1e-9) << i;
    const auto line = joint::generator_at(54, phi);
    const double z_in = joint::contact_at(inner.contour, phi).z;
    const double slope = std::tan(std::max(rule, inner.required(phi)));
    EXPECT_NEAR(z_in - lift(inner.contour.cutters, inner.wall, line, slope), clearance[i], 1e-9);
  }
}

struct WallPoint {
  double across, z;  // from the inner wall; the top of one body there
};

/// The tops of all bodies on one phi at many radii of the wall.
std::vector<WallPoint> scan_wall(const joint::RandomNode& node, const Wall& wall, double phi,
                                 int steps) {
  std::vector<WallPoint> out;
  for (int k = 0; k <= steps; ++k) {
    const double across = (wall.outer - wall.inner) * k / steps;
    for (const auto& body : node.bodies)
      if (const auto z = ray::top(body, wall.inner + across, phi))
        out.push_back({across, static_cast<double>(*z)});
  }
  return out;
}

/// The largest slope from the root to any body.
double steepest(const std::vector<WallPoint>& points, double z_root) {
  double slope = -std::numeric_limits<double>::infinity();
  for (const auto& p : points)
    if (p.across > 0.0) slope = std::max(slope, (p.z - z_root) / p.across);
  return slope;
}

/// The height at the inner wall that keeps a line of this slope above every body.
double highest_root(const std::vector<WallPoint>& points, double slope) {
  double root = -std::numeric_limits<double>::infinity();
  for (const auto& p : points) root = std::max(root, p.z - slope * p.across);
  return root;
}

TEST(Required, NeverBelowAScanOfTheWallAndCloseToIt) {
  constexpr std::uint64_t kSeed = 20260103;
  constexpr int kNodes = 60;
  constexpr int kPhases = 40;
  constexpr int kSteps = 150;
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed);
  double below = 0.0;
  double above = 0.0;
  double lift_off = 0.0;
  double lift_below = 0.0;
  double lift_above = 0.0;
  for (int n = 0; n < kNodes; ++n) {
    const auto node = joint::random_node(random, true, n % 3 == 0, n % 2 == 0);
    const Wall wall{0.85 * node.rho, node.rho};
    const auto contour = joint::trace(node.cutters, wall.inner);
    ASSERT_TRUE(contour);
    for (int k = 0; k < kPhases; ++k) {
      const double phi = kTwoPi * (k + 0.31) / kPhases;
      const auto line = joint::generator_at(wall.inner, phi);
      const double z = joint::contact_at(*contour, phi).z;
      const auto points = scan_wall(node, wall, phi, kSteps);
      const double got = required_bevel(contour->cutters, wall, line, z);
      const double want = std::atan(steepest(points, z));
      below = std::max(below, want - got);
      above = std::max(above, got - want);
      if (got < 1.4) {
        const double held = lift(contour->cutters, wall, line, std::tan(got));
        lift_off = std::max(lift_off, std::abs(held - z));
      }
      const double slope = 0.3 * (k % 7 - 3);
      const double lifted = lift(contour->cutters, wall, line, slope);
      const double scanned = highest_root(points, slope);
      lift_below = std::max(lift_below, scanned - lifted);
      lift_above = std::max(lift_above, lifted - scanned);
    }
  }
  std::cout << "below the scan by " << below << ", above by " << above << " rad; lift off "
            << lift_off << ", below " << lift_below << ", above " << lift_above << " mm\n";
  EXPECT_LT(below, 1e-9);
  EXPECT_LT(above, 0.02);  // the scan's own resolution
  EXPECT_LT(lift_off, 1e-8);
  EXPECT_LT(lift_below, 1e-9);
  EXPECT_LT(lift_above, 0.1);  // resolution again, at a silhouette
}

TEST(Required, PlaneOnly) {
  const std::vector<joint::Cutter> plane{joint::PlaneCutter{{0, 0, 10}, {0, -0.5, 1}}};
  const Inner inner{*joint::trace(plane, 30), {30, 35}};
  for (std::size_t degree = 0; degree < 360; degree += 7)
    EXPECT_NEAR(std::tan(inner.required(radians(degree))), 0.5 * std::sin(radians(degree)), 1e-13);
}

}  // namespace
}  // namespace tubecut::bevel
