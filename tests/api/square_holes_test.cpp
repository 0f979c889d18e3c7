// Holes for branches where the branch or the tube with the hole is not round: fences, racks and
// posts as frames, and parts by themselves.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <random>

#include "core/base/angle.hpp"
#include "core/section/section.hpp"
#include "tests/support/call.hpp"
#include "tests/support/drawings.hpp"

namespace tubecut::testing::square_holes {

using api::Json;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Random = std::mt19937;

constexpr const char* kFrames = "/v1/frames";
constexpr const char* kParts = "/v1/parts";
constexpr double kWritten = 1e-3;  // mm, of coordinates

Json parsed(const std::string& text) { return *api::parse(text); }

/// Coordinates with three decimals; a direction with six.
Json three(const Vector3d& v, double unit) {
  const auto tidy = [&](double x) { return Json{std::round(x / unit) * unit}; };
  return Json{Json::Array{tidy(v.x()), tidy(v.y()), tidy(v.z())}};
}

/// A tube of a fence: its size as a request gives it.
struct Size {
  std::string fields;
  double height, width, corner;  // of a round one its radius is the corner
  bool round = false;
};
const Size kRail{R"({"kind": "rectangular_tube", "height_mm": 50, "width_mm": 40, "wall_mm": 3,
                     "corners": "en_10219"})",
                 50, 40, 6};
const Size kPicket{R"({"size": "SHS 20x20x2 EN 10219"})", 20, 20, 4};
const Size kBar{R"({"outer_diameter_mm": 21.3, "wall_mm": 2})", 21.3, 21.3, 10.65, true};
const Size kOval{R"({"kind": "flat_oval_tube", "height_mm": 26, "width_mm": 16, "wall_mm": 2})", 26,
                 16, 8};
const Size kPost{R"({"outer_diameter_mm": 88.9, "wall_mm": 4})", 88.9, 88.9, 44.45, true};

struct Tube {
  std::string id;
  Size size;
  Vector3d start, finish, up;
};

struct Fence {
  std::vector<Tube> tubes;
  Json::Array joints;
};

Json frame_of(const Fence& fence, const Matrix3d& turn) {
  Json::Array members;
  for (const auto& tube : fence.tubes) {
    auto one = with(parsed(tube.size.fields), "id", tube.id.c_str());
    one = with(one, "start_mm", three(turn * tube.start, kWritten));
    one = with(one, "end_mm", three(turn * tube.finish, kWritten));
    members.push_back(with(one, "up", three(turn * tube.up, 1e-6)));
  }
  auto out = parsed(R"({"preset": "tube_laser", "kerf_mm": 0.2,
                        "sampling": {"tolerance_mm": 0.05}})");
  return with(with(out, "members", Json{std::move(members)}), "joints", Json{fence.joints});
}

/// The distance of a place from a tube's surface, by its own rounded rectangle; negative inside.
double off(const Tube& tube, const Vector3d& place) {
  const Vector3d d = (tube.finish - tube.start).normalized();
  const Vector3d x = (tube.up - tube.up.dot(d) * d).normalized(), y = d.cross(x);
  const Vector3d from = place - tube.start;
  const auto& s = tube.size;
  const Vector2d q(std::abs(from.dot(x)) - 0.5 * s.height + s.corner,
                   std::abs(from.dot(y)) - 0.5 * s.width + s.corner);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - s.corner;
}

/// A row of a cut-out in the world, as it stood before the frame was turned.
Vector3d place_of(const Json& frame, const Size& size, double girth, double z,
                  const Matrix3d& turn) {
  const auto vector = [&](const char* name) {
    const auto v = numbers(frame, name);
    return Vector3d(v[0], v[1], v[2]);
  };
  const Vector3d x = vector("x"), along = vector("z");
  Vector2d p;
  if (size.round)
    p = size.corner * Vector2d(std::cos(girth / size.corner), std::sin(girth / size.corner));
  else
    p = section::Curve(size.height, size.width, size.corner).at(girth).point;
  return turn.transpose() * (vector("origin_mm") + p.x() * x + p.y() * along.cross(x) + z * along);
}

/// Every hole's outer edge clears its branch by the gap, and stays near it.
void expect_fits(const Fence& fence, const Json& answer, const Matrix3d& turn, double gap,
                 std::size_t holes) {
  std::map<std::string, const Json*> parts;
  for (const auto& one : *at(answer, "parts").as<Json::Array>()) parts[text(one, "part")] = &one;
  const auto& members = *at(answer, "result/members").as<Json::Array>();
  std::size_t seen = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto* problem = parts.at(text(members[i], "part"))->find("problem");
    ASSERT_EQ(problem, nullptr) << api::dump(*problem);
    const auto* cutouts = at(*parts.at(text(members[i], "part")), "answer/result").find("cutouts");
    if (cutouts == nullptr) continue;
    for (const auto& group : *cutouts->as<Json::Array>()) {
      ++seen;
      const bool round = fence.tubes[i].size.round;
      const auto z = numbers(group, "points/z_mm");
      auto girth = numbers(group, round ? "points/phi_deg" : "points/girth_mm");
      if (round)
        for (double& one : girth) one *= kRadPerDeg * fence.tubes[i].size.corner;
      const Tube* branch = nullptr;
      double nearest = 1e9;
      for (const auto& tube : fence.tubes) {
        if (tube.id == fence.tubes[i].id) continue;
        const auto here = std::abs(off(
            tube, place_of(at(members[i], "frame"), fence.tubes[i].size, girth[0], z[0], turn)));
        if (here < nearest) branch = &tube;
        nearest = std::min(nearest, here);
      }
      ASSERT_NE(branch, nullptr);
      double least = 1e9, most = -1e9;
      for (std::size_t k = 0; k < z.size(); ++k) {
        const auto p = place_of(at(members[i], "frame"), fence.tubes[i].size, girth[k], z[k], turn);
        least = std::min(least, off(*branch, p));
        most = std::max(most, off(*branch, p));
      }
      EXPECT_GT(least, gap - 5e-3) << branch->id << " in " << fence.tubes[i].id;
      EXPECT_LT(most, number(group, "hole/greatest_gap_mm") + 5e-3) << branch->id;
    }
  }
  EXPECT_EQ(seen, holes);
}

Json joint(const std::string& branch, const std::string& chord, const char* kind) {
  auto out = parsed(R"({"gap_mm": 0.5})");
  out = with(out, "between", Json{Json::Array{Json{branch}, Json{chord}}});
  return with(out, "kind", Json{std::string(kind)});
}

/// Two rails with bars through both of them, or set in both; the rails may rise as on a stair.
Fence drawn_fence(Random& random, const Size& bar, bool through, double slope) {
  const auto share = [&] { return std::uniform_real_distribution<>(0.0, 1.0)(random); };
  Fence out;
  const Vector3d along = Vector3d(1.0, 0.0, slope).normalized();
  const auto flip = [&](Tube& tube) {
    if (random() % 2 == 0) std::swap(tube.start, tube.finish);
  };
  for (const double height : {100.0, 800.0}) {
    Tube rail{
        "rail " + std::to_string(static_cast<int>(height)), kRail, {0, 0, height}, {}, {0, 0, 1}};
    rail.finish = rail.start + 1500.0 * along;
    flip(rail);
    out.tubes.push_back(rail);
  }
  for (int i = 0; i < 5; ++i) {
    const double x = 150.0 + 250.0 * i + 50.0 * share(), z = slope * x;
    Tube one{"bar " + std::to_string(i), bar, {x, 0, z + 100.0}, {x, 0, z + 800.0}, {0, 1, 0}};
    if (through) {
      one.start.z() -= 80.0;
      one.finish.z() += 80.0;
    }
    if (random() % 3 == 0) one.up = {1, 0, 0};
    flip(one);
    out.tubes.push_back(one);
    for (int rail = 0; rail < 2; ++rail)
      out.joints.push_back(joint(one.id, out.tubes[static_cast<std::size_t>(rail)].id,
                                 through ? "through" : "set_in"));
  }
  return out;
}

TEST(SquareHoles, OfAFenceFitItsBarsHoweverItIsDrawn) {
  Random random(11);
  for (int drawing = 0; drawing < drawings(6, 18); ++drawing) {
    const Size& bar = drawing % 3 == 0 ? kPicket : drawing % 3 == 1 ? kBar : kOval;
    const bool through = drawing % 2 == 0;
    const auto fence = drawn_fence(random, bar, through, drawing % 4 < 2 ? 0.0 : 0.5);
    const Matrix3d turn = Eigen::AngleAxisd(0.1 * drawing, Vector3d::UnitZ()).matrix();
    const auto answer = post(kFrames, frame_of(fence, turn));
    ASSERT_FALSE(answer.outcome.error) << drawing << answer.outcome.body.substr(0, 1500);
    EXPECT_EQ(at(answer.body, "verification/passed"), Json{true}) << drawing;
    expect_fits(fence, answer.body, turn, 0.5, through ? 20 : 10);
  }
}

/// Rails of one kind share a part, and so do bars, whichever way each was drawn.
TEST(SquareHoles, EqualRailsOfAFenceShareAPart) {
  Random random(2);
  auto fence = drawn_fence(random, kPicket, true, 0.0);
  for (int rail = 0; rail < 2; ++rail) {
    auto& one = fence.tubes[static_cast<std::size_t>(rail)];
    if (one.start.x() > one.finish.x()) std::swap(one.start, one.finish);
  }
  const auto answer = post(kFrames, frame_of(fence, Matrix3d::Identity()));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(number(answer.body, "result/totals/parts"), 2.0);
}

/// Rails through round posts and flush with their bore in others: holes in a round tube.
TEST(SquareHoles, OfRoundPostsFitTheirRails) {
  Random random(4);
  for (int drawing = 0; drawing < 6; ++drawing) {
    Fence fence;
    for (int i = 0; i < 3; ++i)
      fence.tubes.push_back(
          {"post " + std::to_string(i), kPost, {800.0 * i, 0, 0}, {800.0 * i, 0, 1000}, {0, 1, 0}});
    const bool through = drawing % 2 == 0;
    const double beside = 2.0 * static_cast<double>(random() % 5);
    for (const double z : {300.0, 700.0}) {
      const double over = through ? 100.0 : 0.0;
      Tube rail{"rail " + std::to_string(static_cast<int>(z)),
                drawing < 3 ? kOval : kRail,
                {-over, beside, z},
                {1600.0 + over, beside, z},
                {0, 0, 1}};
      if (drawing > 3) rail.up = {0, 1, 1};
      if (random() % 2 == 0) std::swap(rail.start, rail.finish);
      fence.tubes.push_back(rail);
      for (int i = 0; i < 3; ++i)
        if (through || i != 1)
          fence.joints.push_back(
              joint(rail.id, "post " + std::to_string(i), through ? "through" : "set_in"));
    }
    const Matrix3d turn = Eigen::AngleAxisd(0.3 * drawing, Vector3d::UnitZ()).matrix();
    const auto answer = post(kFrames, frame_of(fence, turn));
    ASSERT_FALSE(answer.outcome.error) << drawing << answer.outcome.body.substr(0, 1500);
    EXPECT_EQ(at(answer.body, "verification/passed"), Json{true}) << drawing;
    expect_fits(fence, answer.body, turn, 0.5, through ? 12 : 4);
  }
}

Json rail_with(const std::string& holes) {
  return parsed(R"({"preset": "tube_laser", "kerf_mm": 0.2, "sampling": {"uniform_points": 72},
    "target": {"id": "rail", "size": "SHS 60x60x3 EN 10219", "length_mm": 600},
    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "holes": [)" +
                holes + "]}");
}
constexpr const char* kBranch =
    R"({"branch": {"id": "bar", "kind": "rectangular_tube", "height_mm": 20, "width_mm": 20,
        "wall_mm": 2, "corners": "en_10219", "up": [0, 0, 1],
        "axis": {"point_mm": [0, 0, 300], "direction": [1, 0, 0]}},
        "joint": {"kind": "through", "gap_mm": 0.5}})";

/// Closed forms of a bar through both walls: the metal that its holes take, and their places.
TEST(SquareHoles, OfAPartTakeTheBarsOutlineOfBothWalls) {
  const auto answer = post(kParts, rail_with(kBranch));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  const auto& groups = *at(answer.body, "result/cutouts").as<Json::Array>();
  ASSERT_EQ(groups.size(), 2U);
  const double area = 21.0 * 21.0 - (4.0 - kPi) * 4.5 * 4.5;
  for (const auto& group : groups) {
    EXPECT_NEAR(number(group, "volume_mm3"), 3.0 * area, 1e-6);
    EXPECT_EQ(number(group, "hole/index"), 0.0);
    EXPECT_EQ(number(group, "instances/0/z_mm"), 300.0);
  }
  EXPECT_EQ(text(groups[0], "id"), "bar");
  EXPECT_EQ(text(groups[1], "id"), "bar.far");
  const auto plain = post(kParts, without(rail_with(kBranch), "holes"));
  EXPECT_NEAR(number(plain.body, "result/lengths/volume_mm3") -
                  number(answer.body, "result/lengths/volume_mm3"),
              6.0 * area, 1e-5);
  EXPECT_NEAR(number(answer.body, "result/lengths/long_mm"), 600.0, 1e-9);
}

/// Sizes and places in inches, the branches as members of a node: a stub set in, and a leg through.
TEST(SquareHoles, OfAMemberInInchesAreThoseOfItsBranches) {
  const auto body = parsed(R"({"preset": "tube_laser", "kerf_mm": 0.3, "connect": {"within_mm": 1},
    "member": "chord", "holes": [{"member": "stub"}, {"member": "leg"}], "members": [
    {"id": "chord", "start_mm": [0, 0, 0], "end_mm": [914.4, 0, 0], "kind": "rectangular_tube",
     "height_mm": 76.2, "width_mm": 50.8, "wall_mm": 4.775, "corners": "astm_a500", "up": [0, 0, 1]},
    {"id": "stub", "start_mm": [457.2, 0, 0], "end_mm": [457.2, 0, 304.8],
     "outer_diameter_mm": 26.67, "wall_mm": 2.87,
     "joints": [{"member": "chord", "kind": "set_in", "gap_mm": 0.4}]},
    {"id": "leg", "start_mm": [254, 0, 300], "end_mm": [254, 0, -300], "kind": "rectangular_tube",
     "height_mm": 19.05, "width_mm": 25.4, "wall_mm": 1.651, "corners": "astm_a500",
     "up": [1, 0, 0], "joints": [{"member": "chord", "kind": "through", "gap_mm": 0.4}]}]})");
  const auto answer = post(kParts, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  const auto& groups = *at(answer.body, "result/cutouts").as<Json::Array>();
  ASSERT_EQ(groups.size(), 3U);
  const double bore = 0.25 * kPi * 27.47 * 27.47;
  EXPECT_NEAR(number(groups[0], "area_outer_mm2"), bore, 1e-6);
  EXPECT_NEAR(number(groups[0], "instances/0/z_mm"), 457.2, 1e-9);
  for (const auto& group : groups) EXPECT_NEAR(number(group, "hole/greatest_gap_mm"), 0.4, 1e-9);
  EXPECT_NE(number(groups[1], "instances/0/face"), number(groups[2], "instances/0/face"));
}

/// Branches without a name, or with that of a cut-out, have names of their own.
/// A round chord with holes for a round and for a square branch: whichever comes first, each joint
/// has the weld that it has alone.
TEST(SquareHoles, StandNextToRoundOnesInOneChord) {
  const std::string chord =
      R"({"id": "chord", "start_mm": [0, 0, 0], "end_mm": [1000, 0, 0], "size": "CHS 88.9x4"})";
  const std::string round =
      R"({"id": "round", "start_mm": [700, 0, 0], "end_mm": [700, 0, 400],
          "size": "CHS 33.7x2.6", "priority": 1})";
  const std::string square =
      R"({"id": "square", "start_mm": [250, 0, 0], "end_mm": [250, 0, 400],
          "size": "SHS 25x25x2 EN 10219", "up": [1, 0, 0], "priority": 1})";
  const auto frame = [&](const std::vector<std::string>& names, const std::string& kind) {
    std::string members = chord, joints;
    for (const auto& name : names) {
      members += "," + (name == "round" ? round : square);
      joints += (joints.empty() ? "" : ",") + std::string(R"({"between": [")") + name +
                R"(", "chord"], "kind": ")" + kind + "\"" +
                (kind == "set_on" ? R"(, "hole": "cut")" : "") + "}";
    }
    return parsed(R"({"preset": "tube_laser", "kerf_mm": 0.3, "members": [)" + members +
                  R"(], "joints": [)" + joints + "]}");
  };
  for (const std::string kind : {"set_in", "set_on"}) {
    std::map<std::string, double> alone;
    for (const std::string name : {"round", "square"}) {
      const auto answer = post(kFrames, frame({name}, kind));
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 500);
      alone[name] = number(answer.body, "result/joints/0/weld_mm");
    }
    for (const auto& names : {std::vector<std::string>{"round", "square"},
                              std::vector<std::string>{"square", "round"}}) {
      const auto answer = post(kFrames, frame(names, kind));
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 500);
      for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_NEAR(number(answer.body, "result/joints/" + std::to_string(i) + "/weld_mm"),
                    alone[names[i]], 1e-6)
            << kind << " " << names[i];
    }
  }
}

/// Over corners: a tube as wide as the rail set on it, a square brace that leans, and a stay that
/// leans to the side through both walls.
TEST(SquareHoles, GoOverCorners) {
  const auto body = rail_with(
      R"({"branch": {"id": "post", "size": "CHS 60.3x3.2",
                     "axis": {"point_mm": [0, 0, 120], "direction": [1, 0, 0]}},
          "joint": {"kind": "set_on"}},
         {"branch": {"id": "brace", "size": "SHS 50x50x3 EN 10219", "up": [0, 1, 0],
                     "axis": {"point_mm": [0, 0, 240], "direction": [1, 0, 1]}},
          "joint": {"kind": "set_in", "gap_mm": 0.3}},
         {"branch": {"id": "stay", "size": "CHS 42.4x2.6",
                     "axis": {"point_mm": [0, 0, 460], "direction": [0.2, 1, -0.5]}},
          "joint": {"kind": "through", "gap_mm": 0.5}})");
  const auto answer = post(kParts, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  const auto& groups = *at(answer.body, "result/cutouts").as<Json::Array>();
  ASSERT_EQ(groups.size(), 4U);
  for (const auto& group : groups) EXPECT_EQ(text(group, "wall"), "developed");
  // The post's bore on the outside: 53.9 along the rail, and round the corners of 6 mm.
  const double half = 0.5 * 60.3 - 3.2, round = 24.0 + 6.0 * std::asin((half - 24.0) / 6.0);
  EXPECT_NEAR(number(groups[0], "instances/0/z_from_mm"), 120.0 - half, 1e-3);
  EXPECT_NEAR(number(groups[0], "instances/0/girth_to_mm"), round, 1e-3);
  EXPECT_NEAR(number(groups[0], "instances/0/girth_from_mm"), -round, 1e-3);
  for (std::size_t i = 1; i < groups.size(); ++i)
    EXPECT_GT(number(groups[i], "hole/greatest_gap_mm"), number(groups[i], "hole/gap_mm"));
  // The stay leaves by opposite faces, alike.
  EXPECT_NEAR(number(groups[2], "area_outer_mm2") / number(groups[3], "area_outer_mm2"), 1.0, 1e-6);
  const auto wide = with(body, "holes/1/branch/size", Json{"SHS 60x60x3 EN 10219"});
  expect_refused(kParts, wide, "/holes/1/branch", "open_profile");
}

/// A square branch that leans in a round tube.
TEST(SquareHoles, OfALeaningBranchGoIntoARoundTube) {
  auto body = with(rail_with(kBranch), "target/size", Json{"CHS 60.3x3.2"});
  body = with(body, "holes/0/branch/axis/direction", parsed("[1, 0, 0.8]"));
  const auto answer = post(kParts, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  const auto& groups = *at(answer.body, "result/cutouts").as<Json::Array>();
  ASSERT_EQ(groups.size(), 2U);
  for (const auto& group : groups) {
    EXPECT_EQ(text(group, "wall"), "developed");
    EXPECT_GT(number(group, "hole/greatest_gap_mm"), 0.5);
  }
}

TEST(SquareHoles, HaveNamesOfTheirOwn) {
  auto body = rail_with(std::string(kBranch) + "," + kBranch + "," + kBranch);
  for (int i = 0; i < 3; ++i) {
    const auto branch = "holes/" + std::to_string(i) + "/branch";
    body = with(body, branch + "/axis/point_mm", three({0, 0, 100.0 + 150.0 * i}, 1.0));
    if (i > 0) body = without(body, branch + "/id");
  }
  body = with(body, "cutouts", parsed(R"([{"id": "bar", "shape": {"kind": "circle",
    "diameter_mm": 9}, "at": {"z_mm": 550, "face": 1}}])"));
  const auto answer = post(kParts, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  std::map<std::string, int> names;
  for (const auto& group : *at(answer.body, "result/cutouts").as<Json::Array>())
    ++names[text(group, "id")];
  EXPECT_EQ(names.size(), 7U);
  EXPECT_EQ(names.count("bar.2.far"), 1U);
}

TEST(SquareHoles, EveryProblemIsAtItsField) {
  const auto body = rail_with(kBranch);
  const auto refused = [&](const std::string& field, const Json& value, const std::string& pointer,
                           const char* code) {
    expect_refused(kParts, with(body, "holes/0/" + field, value), "/holes/0/" + pointer, code);
  };
  refused("tilt", Json{"free"}, "tilt", "bad_choice");
  refused("groove", parsed(R"({"rule": "none"})"), "groove/rule", "bad_choice");
  refused("branch/width_mm", Json{54.0}, "branch", "open_profile");
  expect_refused(kParts,
                 with(with(body, "holes/0/branch/axis/direction", parsed("[0, 0, 1]")),
                      "holes/0/branch/up", parsed("[1, 0, 0]")),
                 "/holes/0/branch/axis", "parallel_axes");
  refused("branch/axis/direction", parsed("[0, 0, 0]"), "branch/axis/direction", "zero_length");
  refused("branch/axis/point_mm", parsed("[0, 100, 300]"), "branch/axis", "open_profile");
  refused("branch/axis/point_mm", parsed("[0, 0, 5]"), "branch", "cutout_off_part");
  refused("branch/up", parsed("[2, 0, 0]"), "branch/up", "bad_reference_direction");
  refused("branch/kind", Json{"square_tube"}, "branch/kind", "unsupported_combination");
  refused("joint/depth_mm", Json{5.0}, "joint/depth_mm", "unsupported_combination");
  refused("joint/kind", Json{"mitre"}, "joint/kind", "bad_choice");
  expect_refused(kParts, rail_with(std::string(kBranch) + "," + kBranch), "/holes/1/branch",
                 "cutouts_cross");
}

}  // namespace tubecut::testing::square_holes
