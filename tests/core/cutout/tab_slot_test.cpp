#include "core/cutout/tab_slot.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/angle.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::testing {
namespace {

using namespace cutout;
using api::Json;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPoint = 1e-9;  // mm, of the golden file

Vector3d direction(const Json& of, const char* path) {
  const auto all = numbers(of, path);
  return Vector3d(all[0], all[1], all[2]).normalized();
}

/// Directions of the golden file have eleven decimals; square ones are made square again.
Tab tab_of(const Json& of) {
  Tab out{.axis = direction(of, "axis"),
          .width = number(of, "tab_width"),
          .thickness = number(of, "tab_thickness")};
  const Vector3d face = direction(of, "face_normal");
  out.face = (face - face.dot(out.axis) * out.axis).normalized();
  return out;
}

/// A tab on any face of a tube that meets a wall at 30 to 90 deg.
struct RandomFit {
  Tab tab;
  PlaneWall wall;
  TabClearance clearance;
};
std::vector<RandomFit> random_fits() {
  std::mt19937 random(53);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<RandomFit> out;
  while (out.size() < 200) {
    RandomFit one;
    one.wall = {Vector3d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5).normalized(),
                2.0 + 8.0 * unit(random)};
    one.tab.axis =
        Vector3d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5).normalized();
    if (-one.tab.axis.dot(one.wall.normal) < 0.5) continue;
    const double turn = kTwoPi * unit(random);
    const Vector3d side = one.tab.axis.unitOrthogonal();
    one.tab.face = std::cos(turn) * side + std::sin(turn) * one.tab.axis.cross(side);
    one.tab.width = 10.0 + 40.0 * unit(random);
    one.tab.thickness = 1.5 + 6.0 * unit(random);
    one.clearance = {0.05 + 0.5 * unit(random), 0.05 + 0.5 * unit(random)};
    out.push_back(one);
  }
  return out;
}

TEST(TabSlot, PlaneWallsHaveTheSlotsOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  int cases = 0;
  for (const auto& one : *at(all, "tabs").as<Json::Array>()) {
    if (one.find("wall_normal") == nullptr) continue;
    const auto slot = slot_in_plane(
        tab_of(one), {direction(one, "wall_normal"), number(one, "wall")}, TabClearance{});
    EXPECT_NEAR(slot.length, number(one, "slot_along"), kPoint) << text(one, "name");
    EXPECT_NEAR(slot.width, number(one, "slot_across"), kPoint) << text(one, "name");
    EXPECT_NEAR(slot.middle.dot(slot.along), number(one, "middle/0"), kPoint);
    EXPECT_NEAR(slot.middle.dot(slot.across), number(one, "middle/1"), kPoint);
    ++cases;
  }
  EXPECT_EQ(cases, 4);
}

TEST(TabSlot, RoundWallsHaveTheSlotsOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  int cases = 0;
  for (const auto& one : *at(all, "tabs").as<Json::Array>()) {
    if (one.find("section") == nullptr) continue;
    const RoundWall wall{number(one, "section/ro"), number(one, "section/ri")};
    const double w = number(one, "tab_width"), t = number(one, "tab_thickness");
    ++cases;
    if (one.find("axis_deg") != nullptr) {
      const double alpha = number(one, "axis_deg") * kRadPerDeg;
      const auto slot = slot_in_round({.width = {w, 0.0},
                                       .thickness = {0.0, t / std::sin(alpha)},
                                       .lean = 1.0 / std::tan(alpha)},
                                      wall, {0.0, 0.0});
      EXPECT_NEAR(slot.along, number(one, "slot_along"), kPoint);
      EXPECT_NEAR(slot.high - slot.low, number(one, "slot_round"), kPoint);
      continue;
    }
    const bool across = text(one, "name") == "round_wall_tab_across";
    const double c = number(one, "clearance");
    const Vector2d width = across ? Vector2d(w, 0.0) : Vector2d(0.0, w);
    const Vector2d thickness = across ? Vector2d(0.0, t) : Vector2d(t, 0.0);
    const auto slot = slot_in_round({.width = width, .thickness = thickness}, wall, {c, c});
    // The file states a prism's side around the tube first.
    EXPECT_NEAR(slot.high - slot.low, number(one, "prism/0"), kPoint);
    EXPECT_NEAR(slot.along, number(one, "prism/1"), kPoint);
    EXPECT_NEAR(slot.round, number(one, "developed_round"), kPoint);
    EXPECT_NEAR(slot.along, number(one, "developed_along"), kPoint);
    EXPECT_NEAR(slot.turn, 0.0, 1e-15);
  }
  EXPECT_EQ(cases, 3);
}

TEST(TabSlot, ATabSetInAndSquareToEitherSideHasItsShortForms) {
  const double alpha = 50.0 * kRadPerDeg, t = 5.0, slide = t / std::tan(alpha);
  const Vector3d d(std::cos(alpha), 0.0, -std::sin(alpha));
  const TabClearance free{0.2, 0.3};
  const PlaneWall wall{Vector3d::UnitZ(), t};
  const Vector3d in_plane(std::sin(alpha), 0.0, std::cos(alpha));
  const auto leaning = slot_in_plane({d, in_plane, 25.0, 3.0}, wall, free);
  EXPECT_NEAR(leaning.length, 25.0 + 0.4, kPoint);
  EXPECT_NEAR(leaning.width, 3.0 / std::sin(alpha) + slide + 0.6, kPoint);
  const auto sideways = slot_in_plane({d, Vector3d::UnitY(), 25.0, 3.0}, wall, free);
  EXPECT_NEAR(sideways.length, 25.0 / std::sin(alpha) + slide + 0.4, kPoint);
  EXPECT_NEAR(sideways.width, 3.0 + 0.6, kPoint);
}

TEST(TabSlot, TabCornersKeepTheClearancesAtEveryDepth) {
  for (const auto& one : random_fits()) {
    const auto slot = slot_in_plane(one.tab, one.wall, one.clearance);
    const double lacks = tab_lacks(one.tab, one.wall, slot, one.clearance, 0.0);
    EXPECT_NEAR(lacks, 0.0, 1e-9);  // the smallest such slot: some corner has no more
    auto tight = slot;
    tight.width -= 1e-3;
    EXPECT_NEAR(tab_lacks(one.tab, one.wall, tight, one.clearance, 0.0), 0.5e-3, 1e-9);
    tight = slot;
    tight.middle += 1e-3 * slot.along;
    EXPECT_NEAR(tab_lacks(one.tab, one.wall, tight, one.clearance, 0.0), 1e-3, 1e-9);
  }
}

/// Pushes the tab along its axis through the wall; returns the least distance of its four sides'
/// points to the slot's walls.
double least_free(const RandomFit& fit, const PlaneSlot& slot) {
  const auto &d = fit.tab.axis, &n = fit.wall.normal;
  const Vector3d e = fit.tab.face.cross(d);
  const double reach = fit.wall.thickness / -d.dot(n);
  double least = 1e9;
  const auto see = [&](double along, double a, double b) {
    const Vector3d p = along * d + a * fit.tab.width * e + b * fit.tab.thickness * fit.tab.face;
    const double depth = -p.dot(n);
    if (depth < 0.0 || depth > fit.wall.thickness) return;
    const Vector3d off = p - slot.middle;
    least = std::min({least, 0.5 * slot.length - std::abs(off.dot(slot.along)),
                      0.5 * slot.width - std::abs(off.dot(slot.across))});
  };
  // The sides of the tab are lines along its axis: a grid of them, and of places along each.
  for (int i = 0; i <= 20; ++i)
    for (int k = 0; k <= 60; ++k) {
      const double along = (k / 60.0 * 3.0 - 1.0) * (reach + fit.tab.width);
      for (const double side : {-0.5, 0.5}) {
        see(along, side, i / 20.0 - 0.5);
        see(along, i / 20.0 - 0.5, side);
      }
    }
  return least;
}

TEST(TabSlot, ATabPushedAlongItsAxisNeverTouches) {
  for (const auto& one : random_fits()) {
    const auto slot = slot_in_plane(one.tab, one.wall, one.clearance);
    EXPECT_GE(least_free(one, slot), std::min(one.clearance.width, one.clearance.thickness) - 1e-9);
  }
}

TEST(TabSlot, TheLargestCornerIsTheOneThatASharpTabTouches) {
  const TabClearance even{0.2, 0.2};
  EXPECT_NEAR(largest_slot_corner(even), (2.0 + std::sqrt(2.0)) * 0.2, 1e-15);
  for (const auto& free : {even, TabClearance{0.1, 0.4}, TabClearance{0.5, 0.15}}) {
    const Tab tab{.width = 30.0, .thickness = 4.0};
    const PlaneWall wall{Vector3d::UnitZ(), 5.0};
    const auto slot = slot_in_plane(tab, wall, free);
    const double r = largest_slot_corner(free);
    EXPECT_NEAR(tab_lacks(tab, wall, slot, free, r), 0.0, 1e-12);
    EXPECT_GT(tab_lacks(tab, wall, slot, free, 1.05 * r), 1e-3);
    EXPECT_LE(tab_lacks(tab, wall, slot, free, 0.5 * r), 1e-12);
  }
}

TEST(TabSlot, AFilletHoldsTheShoulderOffUntilItTouchesTheSlotsEdge) {
  EXPECT_EQ(shoulder_stands_off(0.15, 0.2), 0.0);
  EXPECT_EQ(shoulder_stands_off(0.2, 0.2), 0.0);
  // The slot's edge lies c next to the tab, on the fillet's circle.
  const double r = 0.75, c = 0.2, off = shoulder_stands_off(r, c);
  EXPECT_GT(off, 0.0);
  EXPECT_NEAR(std::hypot(r - c, r - off), r, 1e-12);
  EXPECT_NEAR(shoulder_stands_off(r, 0.0), r, 1e-15);
}

/// A tab of either orientation that leans by up to 60 deg, off a round tube's middle too.
struct RoundFit {
  RoundTab tab;
  RoundWall wall;
  Vector2d clearance;
};
std::vector<RoundFit> random_round_fits() {
  std::mt19937 random(54);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<RoundFit> out;
  while (out.size() < 200) {
    RoundFit one;
    one.wall.outer = 20.0 + 100.0 * unit(random);
    one.wall.inner = one.wall.outer * (0.75 + 0.2 * unit(random));
    one.clearance = {0.05 + 0.5 * unit(random), 0.05 + 0.5 * unit(random)};
    const double y = one.wall.inner * (0.05 + 0.4 * unit(random)), z = 2.0 + 40.0 * unit(random);
    // Its sides may be a little askew.
    const double turn = 0.02 * (unit(random) - 0.5);
    one.tab.width = Vector2d(y, turn * y);
    one.tab.thickness = Vector2d(-turn * z, z);
    if (unit(random) < 0.5) std::swap(one.tab.width, one.tab.thickness);
    one.tab.middle = {0.8 * one.wall.inner * (unit(random) - 0.5), 50.0 * unit(random)};
    one.tab.lean = 3.0 * (unit(random) - 0.5);
    if (one.tab.farthest() + one.clearance.x() > 0.9 * one.wall.inner) continue;
    out.push_back(one);
  }
  return out;
}

/// Grows the tab by its clearances and takes it apart into places of the wall; returns by how much
/// they lie beyond a slot's sides at most, in mm across the tube and along it.
Vector2d beyond(const RoundFit& fit, const RoundSlot& slot, RoundCut cut) {
  constexpr int kSides = 60, kDepths = 60;
  const Vector2d half = fit.tab.half() + fit.clearance;
  Vector2d out(-1e9, -1e9);
  for (int i = -kSides; i <= kSides; ++i) {
    const double y = fit.tab.middle.x() + half.x() * i / kSides;
    const double from = std::sqrt(fit.wall.inner * fit.wall.inner - y * y);
    const double to = std::sqrt(fit.wall.outer * fit.wall.outer - y * y);
    for (int k = 0; k <= kDepths; ++k) {
      const double x = from + (to - from) * k / kDepths, rho = std::hypot(x, y);
      const double phi = std::atan2(y, x) - slot.turn;
      const double around = cut == RoundCut::square
                                ? rho * (std::abs(phi) - 0.5 * slot.round / fit.wall.outer)
                                : std::max(slot.low - y, y - slot.high);
      for (const double side : {-1.0, 1.0}) {
        const double z = fit.tab.middle.y() + fit.tab.lean * x + side * half.y();
        out = out.cwiseMax(Vector2d(around, std::abs(z - slot.z) - 0.5 * slot.along));
      }
    }
  }
  return out;
}

TEST(TabSlot, ATabGrownByItsClearancesJustFillsItsSlotInARoundWall) {
  for (const auto& one : random_round_fits()) {
    const auto slot = slot_in_round(one.tab, one.wall, one.clearance);
    for (const auto cut : {RoundCut::square, RoundCut::prism}) {
      const Vector2d over = beyond(one, slot, cut);
      EXPECT_LE(over.x(), 1e-9);
      EXPECT_LE(over.y(), 1e-9);
      EXPECT_GE(over.x(), -1e-9);  // the smallest such slot
      EXPECT_GE(over.y(), -0.02 * one.wall.outer);
    }
  }
}

TEST(TabSlot, InARoundWallTabCornersKeepTheClearancesAtEveryDepth) {
  for (const auto& one : random_round_fits()) {
    const auto slot = slot_in_round(one.tab, one.wall, one.clearance);
    EXPECT_NEAR(tab_lacks(one.tab, one.wall, slot, RoundCut::square, one.clearance, 0.0), 0.0,
                1e-9);
    auto tight = slot;
    tight.round -= 2e-3 * one.wall.outer / one.wall.inner;
    EXPECT_GT(tab_lacks(one.tab, one.wall, tight, RoundCut::square, one.clearance, 0.0), 4e-4);
    auto moved = slot;
    moved.turn += 0.01;
    EXPECT_GT(tab_lacks(one.tab, one.wall, moved, RoundCut::square, one.clearance, 0.0), 0.05);
  }
}

TEST(TabSlot, OnARoundWallTheClearanceIsThatOnTheBore) {
  const RoundWall wall{44.45, 39.45};
  const auto laid =
      slot_in_round({.width = {30.0, 0.0}, .thickness = {0.0, 4.0}}, wall, {0.3, 0.3});
  const double turn = 0.5 * laid.round / wall.outer;
  EXPECT_NEAR(wall.inner * std::sin(turn), 15.0 + 0.3, 1e-12);
  EXPECT_GT(wall.outer * std::sin(turn), 15.0 + 0.3);
}

TEST(TabSlot, OffTheMiddleASlotsInnerSideClearsTheTabOutside) {
  const RoundWall wall{44.45, 39.45};
  const auto laid = slot_in_round(
      {.middle = {20.0, 0.0}, .width = {0.0, 30.0}, .thickness = {4.0, 0.0}}, wall, {0.3, 0.2});
  const double half = 0.5 * laid.round / wall.outer;
  EXPECT_NEAR(wall.outer * std::sin(laid.turn - half), 18.0 - 0.3, 1e-12);
  EXPECT_NEAR(wall.inner * std::sin(laid.turn + half), 22.0 + 0.3, 1e-12);
  EXPECT_NEAR(laid.along, 30.4, 1e-12);
}

}  // namespace
}  // namespace tubecut::testing
