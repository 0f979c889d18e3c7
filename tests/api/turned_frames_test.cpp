// Laws of frames: a model that is turned, mirrored or written with three decimals has the parts,
// marks and refusals of the model as it was drawn.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "core/section/section.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::turned_frames {

using api::Json;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr const char* kFrames = "/v1/frames";

struct Bar {
  std::string id;
  Vector3d start, finish, up;
  std::string tube;  // its fields
  int priority = 0;
};

/// How a model is placed in the world: turned, moved, and its coordinates rounded.
struct Place {
  Matrix3d turn = Matrix3d::Identity();
  Vector3d shift = Vector3d::Zero();
  bool rounded = false;

  [[nodiscard]] Json point(const Vector3d& drawn) const {
    const Vector3d at = turn * drawn + shift;
    return rounded ? numbers((1e3 * at).array().round() / 1e3) : numbers(at);
  }
  [[nodiscard]] static Json numbers(const Vector3d& v) {
    return Json{Json::Array{Json{v.x()}, Json{v.y()}, Json{v.z()}}};
  }
};

Place in_plan(double degrees, bool rounded) {
  return {.turn = Eigen::AngleAxisd(degrees * kRadPerDeg, Vector3d::UnitZ()).matrix(),
          .shift = {100, 200, 0},
          .rounded = rounded};
}

constexpr const char* kShs20 =
    R"("kind": "rectangular_tube", "height_mm": 20, "width_mm": 20, "wall_mm": 2,
       "corners": "en_10219")";
constexpr const char* kShs30 =
    R"("kind": "rectangular_tube", "height_mm": 30, "width_mm": 30, "wall_mm": 2,
       "corners": "en_10219")";
constexpr const char* kShs40 =
    R"("kind": "rectangular_tube", "height_mm": 40, "width_mm": 40, "wall_mm": 3,
       "corners": "en_10219")";

/// `once`: fields that are given once.
Json frame(const std::vector<Bar>& bars, const Place& place, const std::string& once) {
  auto out = *api::parse("{" + once + R"(, "connect": {"within_mm": 5}})");
  Json::Array members;
  for (const auto& bar : bars) {
    auto member = *api::parse("{" + bar.tube + "}");
    member = with(member, "id", Json{bar.id});
    member = with(member, "start_mm", place.point(bar.start));
    member = with(member, "end_mm", place.point(bar.finish));
    if (bar.up.norm() > 0.0) member = with(member, "up", Place::numbers(place.turn * bar.up));
    members.push_back(with(member, "priority", Json{static_cast<double>(bar.priority)}));
  }
  return with(out, "members", Json{std::move(members)});
}

constexpr const char* kLaser =
    R"("preset": "tube_laser", "kerf_mm": 0.2, "sampling": {"tolerance_mm": 0.05})";

Json answered(const Json& asked) {
  const auto answer = post(kFrames, asked);
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  return answer.body;
}

using Groups = std::set<std::set<std::string>>;
Groups groups_of(const Json& answer) {
  Groups out;
  for (const auto& row : *at(answer, "result/cut_list").as<Json::Array>()) {
    std::set<std::string> one;
    for (const auto& id : *at(row, "members").as<Json::Array>()) one.insert(*id.as<std::string>());
    out.insert(std::move(one));
  }
  return out;
}

/// The details of the answer's warnings of a code.
std::vector<std::string> warned(const Json& answer, std::string_view code) {
  std::vector<std::string> out;
  for (const auto& one : *at(answer, "warnings").as<Json::Array>())
    if (text(one, "code") == code) out.push_back(text(one, "detail"));
  return out;
}

/// The half-round edge of a flat oval has no flat, so a post that is wider than it is no flat end
/// on a face: the same refusal in every orientation.
TEST(TurnedFrames, TheEdgeOfAFlatOvalIsNoFace) {
  const std::string oval =
      R"("kind": "flat_oval_tube", "height_mm": 60, "width_mm": 30, "wall_mm": 2)";
  const std::vector<Bar> bars{{"rail", {-500, 0, 0}, {500, 0, 0}, {0, 0, 1}, oval, 0},
                              {"post", {0, 0, 0}, {0, 0, 500}, {0, 1, 0}, kShs40, 1}};
  std::vector<Place> places;
  for (int i = 0; i < 30; ++i) places.push_back(in_plan(12.0 * i, i % 3 == 1));
  for (int i = 0; i < 30; ++i) {
    const Vector3d axis = Vector3d(std::sin(1.0 + i), std::cos(2.0 * i), std::sin(3.0 * i));
    places.push_back({.turn = Eigen::AngleAxisd(0.4 * i, axis.normalized()).matrix()});
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto why = warned(answered(frame(bars, places[i], kLaser)), "no_part");
    ASSERT_EQ(why.size(), 1u) << i;
    EXPECT_TRUE(why[0].starts_with("post: open_profile")) << i << " " << why[0];
  }
}

/// The place along the girth where a rail's axis leaves a post whose height is turned by `degrees`
/// from the rail, as its part is asked for.
double mark_of_rail(double degrees) {
  const double turn = degrees * kRadPerDeg;
  const std::vector<Bar> bars{
      {"post", {0, 0, 0}, {0, 0, 650}, {std::cos(turn), std::sin(turn), 0}, kShs30, 0},
      {"rail", {0, 0, 200}, {500, 0, 200}, {0, 0, 1}, kShs20, 1}};
  const auto answer = answered(frame(bars, {}, kLaser));
  for (const auto& part : *at(answer, "parts").as<Json::Array>())
    if (text(part, "part") == "post") return number(part, "answer/request/marks/0/girth_mm");
  return -1.0;
}

/// On a corner the mark follows the axis round the arc, whose middle it passes on the diagonal.
/// Seen in a mirror, it lies as far on the other side of the datum.
TEST(TurnedFrames, AMarkFollowsTheAxisRoundACorner) {
  const auto radii = section::corner_radii(section::Standard::en_10219, 2);
  const section::Curve outer(30, 30, radii.outer);
  EXPECT_NEAR(mark_of_rail(45), outer.on_corner(4, 0.25 * kPi), 1e-5);
  double before = outer.girth();
  for (double degrees = 30; degrees <= 60; degrees += 1.5) {
    const double mark = mark_of_rail(degrees);
    EXPECT_LT(mark, before) << degrees;
    EXPECT_LT(before < outer.girth() ? before - mark : 0.0, 1.5) << degrees;
    EXPECT_NEAR(mark_of_rail(-degrees), outer.girth() - mark, 1e-5) << degrees;
    before = mark;
  }
  for (const double near : {44.9999, 45.0001})
    EXPECT_NEAR(mark_of_rail(near), mark_of_rail(45), 1e-3) << near;
}

/// A stool whose legs point with a corner to its middle has one leg and one rail.
TEST(TurnedFrames, ARailOnACornerSplitsNoLegs) {
  const std::array<Vector3d, 4> corners{Vector3d(0, 0, 0), {400, 0, 0}, {400, 400, 0}, {0, 400, 0}};
  std::vector<Bar> bars;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d next = corners[(i + 1) % 4], up(1, i % 2 == 0 ? 1 : -1, 0);
    const auto name = std::to_string(i);
    bars.push_back({"leg" + name, corners[i], corners[i] + Vector3d(0, 0, 650), up, kShs30, 0});
    bars.push_back({"rail" + name,
                    corners[i] + Vector3d(0, 0, 200),
                    next + Vector3d(0, 0, 200),
                    {0, 0, 1},
                    kShs20,
                    1});
  }
  const Groups expected{{"leg0", "leg1", "leg2", "leg3"}, {"rail0", "rail1", "rail2", "rail3"}};
  EXPECT_EQ(groups_of(answered(frame(bars, {}, kLaser))), expected);
  for (const double degrees : {17.3, 45.0, 121.9})
    for (const bool rounded : {false, true})
      EXPECT_EQ(groups_of(answered(frame(bars, in_plan(degrees, rounded), kLaser))), expected)
          << degrees << rounded;
}

/// The cuts of posts follow the steps below them beyond their ends, by a length that rounding
/// moves: it splits no parts.
TEST(TurnedFrames, AMissingLengthIsComparedAsLengthsAre) {
  const std::string stringer =
      R"("kind": "rectangular_tube", "height_mm": 80, "width_mm": 40, "wall_mm": 3,
         "corners": "en_10219")";
  const std::string round = R"("outer_diameter_mm": 42.4, "wall_mm": 2.6)";
  std::vector<Bar> bars{{"stringer", {0, 0, 0}, {1200, 0, 864}, {0, 0, 1}, stringer, 0}};
  for (const double x : {250.0, 1000.0}) {
    const Vector3d on(x, 0, 0.72 * x);
    const auto name = x < 500 ? "1" : "2";
    bars.push_back(
        {std::string("step") + name, on, on + Vector3d(0, 800, 0), {0, 0, 1}, kShs40, 2});
    bars.push_back(
        {std::string("post") + name, on, on + Vector3d(0, 0, 900), Vector3d::Zero(), round, 3});
  }
  const auto drawn = answered(frame(bars, {}, kLaser));
  EXPECT_EQ(warned(drawn, "ghost_contact").size(), 2u);
  const Groups expected{{"stringer"}, {"step1", "step2"}, {"post1", "post2"}};
  EXPECT_EQ(groups_of(drawn), expected);
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(groups_of(answered(frame(bars, in_plan(22.5 * i - 1.0, true), kLaser))), expected)
        << i;
}

/// Where one mitre plane takes over from another, B jumps: the rounded seats of a tripod jump at
/// phases that differ by 1e-4 deg, and are one part.
TEST(TurnedFrames, EdgesThatJumpElsewhereDifferByTheDistanceOfTheJumps) {
  const std::string tube = R"("outer_diameter_mm": 26.9, "wall_mm": 2.3)";
  std::vector<Bar> bars;
  const auto corner = [](int i) {
    return Vector3d(120 * std::cos(2.0 * kPi * i / 3), 120 * std::sin(2.0 * kPi * i / 3), 0);
  };
  const Vector3d above(0, 0, 650);
  for (int i = 0; i < 3; ++i) {
    const auto name = std::to_string(i);
    bars.push_back({"leg" + name, corner(i), corner(i) + above, Vector3d::Zero(), tube});
    bars.push_back(
        {"seat" + name, corner(i) + above, corner(i + 1) + above, Vector3d::Zero(), tube});
  }
  const std::string torch = R"("kerf_mm": 1, "sampling": {"tolerance_mm": 0.05},
      "defaults": {"root_surface": "inner", "groove": {"rule": "half_dihedral"},
                   "smoothing": {"method": "none"}})";
  const Groups expected{{"leg0", "leg1", "leg2"}, {"seat0", "seat1", "seat2"}};
  for (int i = 0; i < 10; ++i) {
    const auto answer = answered(frame(bars, in_plan(36.0 * i + 5.0, i > 0), torch));
    EXPECT_EQ(groups_of(answer), expected) << i;
    for (const auto& row : *at(answer, "result/cut_list").as<Json::Array>())
      EXPECT_LE(number(row, "differs_at_most_mm"), 0.02) << i;
  }
}

/// A joint has no fields of a cut-out, so the refusal of its hole names what a joint has; the ways
/// that it names lead to a part.
TEST(TurnedFrames, TheHintOfAJointsHoleCanBeFollowed) {
  const auto shs = [](const std::string& side) {
    return R"("kind": "rectangular_tube", "wall_mm": 4, "corners": "en_10210", "height_mm": )" +
           side + R"(, "width_mm": )" + side;
  };
  const auto ladder = [&](const std::string& rung, const std::string& kind) {
    const std::vector<Bar> bars{{"stile", {0, 0, 0}, {0, 0, 2000}, {0, 1, 0}, shs("60"), 0},
                                {"rung", {0, 0, 200}, {500, 0, 200}, {0, 0, 1}, shs(rung), 1}};
    return answered(frame(bars, {}, kLaser + (R"(, "defaults": {"kind": ")" + kind + R"("})")));
  };
  const auto why = warned(ladder("60", "set_in"), "no_part");
  ASSERT_EQ(why.size(), 1u);
  EXPECT_EQ(why[0].find("wall by wall"), std::string::npos) << why[0];
  for (const auto* way : {"set_on", "a narrower branch"})
    EXPECT_NE(why[0].find(way), std::string::npos) << why[0];
  EXPECT_TRUE(warned(ladder("60", "set_on"), "no_part").empty());
  EXPECT_TRUE(warned(ladder("40", "set_in"), "no_part").empty());
}

}  // namespace tubecut::testing::turned_frames
