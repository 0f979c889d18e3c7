// Plates: holes for tubes against the tubes point by point, webs and areas against closed forms.

#include "core/plate/plate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/base/angle.hpp"
#include "core/cutout/hull.hpp"
#include "core/frame/frame.hpp"
#include "core/plate/web.hpp"

namespace tubecut::testing::plates {

using cutout::Chain;
using cutout::Flat;
using Eigen::Vector3d;
using plate::Passage;
using plate::Passing;
using plate::PlateSpec;

constexpr double kEllipse = 2.5e-4;  // mm: arcs for an ellipse, and the margin that they get

PlateSpec base(double thickness = 20.0) {
  PlateSpec out{.name = "BP"};
  out.thickness = thickness;
  out.outline = cutout::Rectangle{300, 200, 0};
  return out;
}

joint::Member round_tube(const Vector3d& from, const Vector3d& to, double radius = 40.0) {
  joint::Member out;
  out.start = from;
  out.finish = to;
  out.outer_radius = radius;
  out.wall = 4.0;
  return out;
}

joint::Member box_tube(const Vector3d& from, const Vector3d& to, const Vector3d& up) {
  auto out = round_tube(from, to);
  out.section = section::Section{80, 40, 4, 8, 4};
  out.up = up;
  return out;
}

plate::Plate made(const PlateSpec& spec, const std::vector<Passing>& passing = {}) {
  auto out = plate::make(spec, passing);
  EXPECT_TRUE(out) << out.error().issues.front().member << out.error().issues.front().hint;
  return out ? *std::move(out) : plate::Plate{};
}

/// Places along a chain.
std::vector<Flat> along(const Chain& chain, int each = 40) {
  std::vector<Flat> out;
  for (const auto& s : chain)
    for (int k = 0; k < each; ++k) out.push_back(s.at((k + 0.5) / each));
  return out;
}

TEST(Plates, BoltHolesTakeTheirCircles) {
  auto spec = base();
  spec.openings = {{.id = "bolt",
                    .shape = cutout::Circle{18},
                    .at = {-120, -70},
                    .pattern = plate::Grid{2, 2, 240, 140}},
                   {.id = "slot", .shape = cutout::Slot{60, 20}, .turn = 0.5 * kPi}};
  const auto plate = made(spec);
  ASSERT_EQ(plate.holes.size(), 5u);
  EXPECT_EQ(plate.holes[2].name, "bolt.3");
  EXPECT_NEAR(plate.holes[2].centre.y(), 70.0, 1e-12);
  const double slot = 40.0 * 20.0 + kPi * 100.0;
  EXPECT_NEAR(plate.area, 300.0 * 200.0 - 4.0 * kPi * 81.0 - slot, 1e-9);
  EXPECT_NEAR(plate.volume, plate.area * 20.0, 1e-6);
  ASSERT_TRUE(plate.web);
  EXPECT_NEAR(plate.web->width, 21.0, 1e-12);  // a bolt hole to both sides
}

TEST(Plates, RingOfAFlangeIsEvenlySpaced) {
  auto spec = base();
  spec.outline = cutout::Circle{200};
  spec.openings = {{.id = "m", .shape = cutout::Circle{18}, .pattern = plate::Ring{8, 160, 0.1}}};
  const auto plate = made(spec);
  ASSERT_EQ(plate.holes.size(), 8u);
  for (const auto& hole : plate.holes) EXPECT_NEAR(hole.centre.norm(), 80.0, 1e-12);
  EXPECT_NEAR(plate.web->width, 11.0, 1e-9);
  const Flat first = plate.holes[0].centre, second = plate.holes[1].centre;
  EXPECT_NEAR((first - second).norm(), 160.0 * std::sin(kPi / 8.0), 1e-9);
}

TEST(Plates, SquareRoundTubeTakesACircleOfItsClearance) {
  const auto plate = made(
      base(), {{{round_tube({30, 10, -200}, {30, 10, 300}), 0.0, -20.0, 1.5}, "T", "joints/0"}});
  const auto& hole = plate.holes.front();
  EXPECT_NEAR(hole.diameter.value(), 83.0, 1e-12);
  EXPECT_NEAR((hole.centre - Flat(30, 10)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(hole.greatest_gap, 1.5, 1e-12);
  EXPECT_NEAR(plate.area, 60000.0 - kPi * 41.5 * 41.5, 1e-8);
}

TEST(Plates, SquareBoxTubeTakesItsOutlineWithCornersOfTheClearance) {
  const auto plate = made(
      base(), {{{box_tube({0, 0, -200}, {0, 0, 300}, {1, 0, 0}), 0, -20, 2.0}, "T", "joints/0"}});
  const double w = 84.0, h = 44.0, r = 10.0;
  EXPECT_NEAR(plate.area, 60000.0 - (w * h - (4.0 - kPi) * r * r), 1e-8);
  const auto box = cutout::bounds(plate.holes.front().chain);
  EXPECT_NEAR(box.most.x(), 42.0, 1e-9);  // the height lies along the member's up
  EXPECT_NEAR(box.most.y(), 22.0, 1e-9);
  const auto down = box_tube({0, 0, 300}, {0, 0, -200}, {1, 0, 0});
  const auto mark = plate::outline_at(down, 0.0, plate.frame).value();
  EXPECT_NEAR(cutout::area(mark), 80.0 * 40.0 - (4.0 - kPi) * 64.0, 1e-8);
}

/// A tube at an angle in a thick plate: the hole is its shadow, an ellipse moved through the
/// thickness.
TEST(Plates, LeaningRoundTubeTakesTheShadowOfItsWholePassage) {
  const double angle = 40.0 * kRadPerDeg, thickness = 25.0, gap = 1.0, radius = 41.0;
  const Vector3d d(std::sin(angle), 0.0, std::cos(angle));
  auto spec = base(thickness);
  spec.outline = cutout::Rectangle{400, 300, 0};
  const auto plate =
      made(spec, {{{round_tube(-300 * d, 300 * d), 0.0, -thickness, gap}, "T", "joints/0"}});
  const auto& hole = plate.holes.front();
  EXPECT_FALSE(hole.diameter);
  const double major = radius / std::cos(angle), way = thickness * std::tan(angle);
  const auto box = cutout::bounds(hole.chain);
  EXPECT_NEAR(box.most.x(), major, 2 * kEllipse);
  EXPECT_NEAR(box.least.x(), -major - way, 2 * kEllipse);
  EXPECT_NEAR(box.most.y(), radius, 2 * kEllipse);
  EXPECT_NEAR(cutout::area(hole.chain), kPi * major * radius + 2.0 * radius * way, 0.1);
  EXPECT_GT(hole.greatest_gap, gap + 0.9 * thickness * std::sin(angle));
}

/// Every depth of random passages: the tube with its gap is within the hole, and touches it.
TEST(Plates, TubesNeverTouchTheirHoles) {
  std::mt19937 random(7);
  const auto any = [&](double a, double b) {
    return std::uniform_real_distribution<>(a, b)(random);
  };
  for (int drawing = 0; drawing < 60; ++drawing) {
    auto spec = base(any(5, 60));
    spec.outline = cutout::Rectangle{3000, 3000, 0};
    spec.point = {any(-500, 500), any(-500, 500), any(-500, 500)};
    spec.normal = Vector3d(any(-1, 1), any(-1, 1), any(-1, 1));
    spec.up = spec.normal.unitOrthogonal() + 0.3 * spec.normal;
    const auto frame = plate::frame_of(spec).value();
    const double lean = any(0, 65) * kRadPerDeg, turn = any(0, kTwoPi);
    const Vector3d local(std::sin(lean) * std::cos(turn), std::sin(lean) * std::sin(turn),
                         std::cos(lean));
    const Vector3d d = frame.rows.transpose() * local;
    const Vector3d at = spec.point + frame.rows.transpose() * Vector3d(any(-50, 50), 20, 0);
    auto tube = drawing % 2 == 0 ? round_tube(at - 400 * d, at + 400 * d, any(5, 60))
                                 : box_tube(at - 400 * d, at + 400 * d, d.unitOrthogonal());
    if (drawing % 3 == 0) std::swap(tube.start, tube.finish);
    const Passage passage{tube, 0.0, -any(0.2, 1) * spec.thickness, any(0, 3)};
    const auto plate = made(spec, {{passage, "T", "joints/0"}});
    double least = 1e9;
    for (const auto& p : along(plate.holes.front().chain))
      for (int k = 0; k <= 20; ++k) {
        const Vector3d on(p.x(), p.y(), passage.from + k / 20.0 * (passage.to - passage.from));
        const Vector3d world = frame.origin + frame.rows.transpose() * on;
        least = std::min(least, plate::off_tube(tube, world));
      }
    EXPECT_GT(least, passage.gap - 1e-6) << drawing;
    EXPECT_LT(least, passage.gap + 0.02) << drawing;  // between the places
    for (const auto& check : plate::verify(spec, {{passage, "T", "joints/0"}}, plate))
      EXPECT_TRUE(check.passed()) << check.name << " " << check.value;
  }
}

TEST(Plates, ATooSmallHoleFailsItsCheck) {
  const std::vector<Passing> passing{
      {{round_tube({0, 0, -200}, {0, 0, 300}), 0.0, -20.0, 1.0}, "T", "joints/0"}};
  auto plate = made(base(), passing);
  plate.holes.front().chain = cutout::circle(81.99);
  const auto checks = plate::verify(base(), passing, plate);
  EXPECT_FALSE(checks.front().passed());
}

TEST(Plates, GapsOfChainsAreThoseOfTheirPlaces) {
  std::mt19937 random(3);
  const auto any = [&](double a, double b) {
    return std::uniform_real_distribution<>(a, b)(random);
  };
  int apart = 0, crossed = 0;
  for (int drawing = 0; drawing < 300; ++drawing) {
    const auto shape = [&] {
      const auto chain = drawing % 3 == 0   ? cutout::slot(any(40, 90), any(5, 40))
                         : drawing % 3 == 1 ? cutout::rectangle(any(20, 90), any(20, 90), 9)
                                            : cutout::circle(any(5, 90));
      return plate::moved(cutout::turned(chain, any(0, 6)), {any(-60, 60), any(-60, 60)});
    };
    const auto a = shape(), b = shape();
    const double gap = plate::gap(a, b);
    double least = 1e9;
    bool in = false, out = false;
    for (const auto& p : along(a, 400)) {
      least = std::min(least, cutout::distance(b, p));
      (plate::encloses(b, p) ? in : out) = true;
      EXPECT_EQ(plate::encloses(b, p), cutout::holds(b, p));
    }
    if (in && out) {
      ++crossed;
      EXPECT_EQ(gap, 0.0);
    } else if (least > 0.5) {
      ++apart;
      EXPECT_LE(gap, least + 1e-9);
      EXPECT_GT(gap, least - 0.3);
    }
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(crossed, 50);
}

struct Refused {
  ErrorCode code;
  std::string member;
};
Refused refused(const PlateSpec& spec, const std::vector<Passing>& passing = {}) {
  const auto out = plate::make(spec, passing);
  if (out) return {ErrorCode::internal_error, "made"};
  return {out.error().code(), out.error().issues.front().member};
}

TEST(Plates, RefuseWhatIsNoPlate) {
  auto spec = base();
  spec.normal = Vector3d::Zero();
  EXPECT_EQ(refused(spec).code, ErrorCode::zero_length);
  spec = base();
  spec.up = {0, 0, 5};
  EXPECT_EQ(refused(spec).code, ErrorCode::bad_reference_direction);
  spec = base();
  spec.outline = cutout::Rectangle{100, 50, 26};
  EXPECT_EQ(refused(spec).member, "outline/corner_radius");
  spec = base();
  spec.outline = cutout::Contour{.start = {0, 0}, .pieces = {{{100, 0}}, {{0, 80}}}};
  EXPECT_EQ(refused(spec).code, ErrorCode::contour_open);
  spec = base();
  spec.openings = {{.id = "a", .shape = cutout::Circle{18}, .at = {142, 0}}};
  EXPECT_EQ(refused(spec).code, ErrorCode::cutout_off_part);
  spec.openings = {{.id = "a", .shape = cutout::Circle{18}, .at = {400, 0}}};
  EXPECT_EQ(refused(spec).code, ErrorCode::cutout_off_part);
  spec.openings = {{.id = "a", .shape = cutout::Circle{18}},
                   {.id = "b", .shape = cutout::Circle{50}}};
  EXPECT_EQ(refused(spec).code, ErrorCode::cutouts_cross);
  EXPECT_EQ(refused(spec).member, "cutouts/1");
  spec.openings[0].at = {40, 0};
  EXPECT_EQ(refused(spec).member, "made");
  spec.least_web = 8.0;  // 40 - 25 - 9 = 6
  EXPECT_EQ(refused(spec).code, ErrorCode::out_of_range);
  spec.openings.clear();
  EXPECT_EQ(
      refused(spec, {{{round_tube({0, 0, -5}, {500, 0, -5}), 0, -20, 1}, "T", "joints/4"}}).member,
      "joints/4");
}

/// A post on a base plate, a rail through its web plate, and a strut set in.
frame::FrameSpec post_and_rail() {
  frame::FrameSpec out;
  out.members = {round_tube({0, 0, 0}, {0, 0, 1000}),
                 round_tube({-500, 0, 600}, {500, 0, 600}, 20)};
  out.members[0].name = "P";
  out.members[1].name = "R";
  out.plates = {base(), base(10.0)};
  out.plates[1].point = {100, 0, 600};
  out.plates[1].normal = {1, 0, 0};
  out.plates[1].up = {0, 0, 1};
  out.joints = {{.member = 0, .with = 0, .how = {.gap = 1.0}, .plate = true},
                {.member = 1, .with = 1, .how = {frame::How::Kind::through, 0.5}, .plate = true},
                {.member = 1, .with = 0, .how = {frame::How::Kind::through, 0.5}}};
  return out;
}

TEST(Plates, PostsEndOnTheFaceAndRailsPass) {
  const auto out = frame::solve(post_and_rail());
  ASSERT_TRUE(out) << out.error().issues.front().hint;
  ASSERT_EQ(out->joints.size(), 3u);
  EXPECT_TRUE(out->joints[0].plate);
  ASSERT_EQ(out->plates.size(), 2u);
  const auto& post = out->pieces[0];
  ASSERT_EQ(post.start.size(), 1u);
  const auto& plane = std::get<joint::PlaneCutter>(post.start[0].partner);
  EXPECT_NEAR(plane.normal.normalized().z(), 1.0, 1e-12);
  EXPECT_NEAR(plane.point.norm(), 0.0, 1e-12);
  EXPECT_EQ(post.start[0].stated->gap, 1.0);
  ASSERT_EQ(out->plates[0].stood.size(), 1u);
  EXPECT_NEAR(cutout::area(out->plates[0].stood[0].outline), kPi * 1600.0, 1e-8);
  ASSERT_EQ(out->plates[1].plate.holes.size(), 1u);
  EXPECT_NEAR(out->plates[1].plate.holes[0].diameter.value(), 41.0, 1e-12);
  EXPECT_TRUE(out->warnings.empty()) << out->warnings.front().detail;
}

TEST(Plates, AnEndSetInIsCutAtItsDepthBelowTheFaceItEntersBy) {
  auto spec = post_and_rail();
  spec.joints[0].how = {.kind = frame::How::Kind::set_in, .gap = 0.5, .depth = 8.0};
  for (const bool above : {true, false}) {
    spec.members[0].finish.z() = above ? 1000.0 : -1000.0;
    spec.joints.resize(above ? 3 : 2);
    const auto out = frame::solve(spec);
    ASSERT_TRUE(out) << out.error().issues.front().hint;
    const auto& plane = std::get<joint::PlaneCutter>(out->pieces[0].start[0].partner);
    // Below the upper face by 8, or above the lower one, which is at -20.
    EXPECT_NEAR(plane.point.dot(plane.normal), above ? -8.0 : 12.0, 1e-12);
    EXPECT_NEAR(out->plates[0].plate.holes[0].diameter.value(), 81.0, 1e-12);
    EXPECT_EQ(out->joints[0].how.depth, 8.0);
  }
  spec.joints[0].how.depth = 21.0;
  EXPECT_EQ(frame::solve(spec).error().issues.front().member, "joints/0/depth");
}

TEST(Plates, ATubeInAPlateWithoutAJointIsReported) {
  auto spec = post_and_rail();
  spec.joints.erase(spec.joints.begin() + 1);
  const auto out = frame::solve(spec).value();
  ASSERT_EQ(out.warnings.size(), 1u);
  EXPECT_EQ(out.warnings[0].code, WarningCode::members_overlap);
  EXPECT_EQ(out.warnings[0].member, "members/1");
  spec.plates[1].openings = {{.id = "wide", .shape = cutout::Circle{44}}};
  EXPECT_TRUE(frame::solve(spec).value().warnings.empty());
}

TEST(Plates, APostOverItsPlateIsReportedAndOneOffItRefused) {
  auto spec = post_and_rail();
  spec.members[0].start.x() = spec.members[0].finish.x() = 130.0;
  const auto out = frame::solve(spec).value();
  const auto wide = std::ranges::find(out.warnings, WarningCode::wall_overhangs, &Warning::code);
  ASSERT_NE(wide, out.warnings.end());
  EXPECT_EQ(wide->member, "members/0/start");
  spec.members[0].start.x() = spec.members[0].finish.x() = 400.0;
  EXPECT_EQ(frame::solve(spec).error().code(), ErrorCode::no_contact);
}

}  // namespace tubecut::testing::plates
