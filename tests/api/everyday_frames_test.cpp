// Frames as shops draw them: rails through posts, pieces that were split at a post, limits that
// hold for some of the parts, and chords that a brace does not reach.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::everyday_frames {

using api::Json;

constexpr const char* kFrames = "/v1/frames";

Json parsed(const std::string& text) { return *api::parse(text); }

/// A request for a laser, without joints.
Json frame(const std::string& members, const std::string& joints) {
  return parsed(R"({"preset": "tube_laser", "kerf_mm": 0.2, "sampling": {"tolerance_mm": 0.05},
                    "members": [)" +
                members + R"(], "joints": [)" + joints + "]}");
}

/// A place of a model that is turned in plan, in mm with three decimals.
std::string turned_place(double degrees, double x, double y, double z) {
  const double c = std::cos(degrees * kRadPerDeg), s = std::sin(degrees * kRadPerDeg);
  const auto rounded = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
  return "[" + rounded(c * x - s * y) + ", " + rounded(s * x + c * y) + ", " + rounded(z) + "]";
}

const std::string kPost =
    R"({"id": "post", "start_mm": [0, 0, 0], "end_mm": [0, 0, 1000], "up": [1, 0, 0],
        "size": "SHS 50x50x3 EN 10219", "priority": 1})";

std::string rail(double from, double to, const std::string& id = "rail") {
  return R"({"id": ")" + id + R"(", "start_mm": [)" + std::to_string(from) +
         R"(, 0, 500], "end_mm": [)" + std::to_string(to) +
         R"(, 0, 500], "up": [0, 0, 1], "kind": "rectangular_tube", "height_mm": 60,
             "width_mm": 20, "wall_mm": 2, "corners": "en_10219", "priority": 2})";
}

std::string through(const std::string& branch, const std::string& chord) {
  return R"({"between": [")" + branch + R"(", ")" + chord +
         R"("], "kind": "through", "gap_mm": 0.5})";
}

/// Part `id` of an answer.
const Json& part(const Posted& answer, const std::string& id) {
  static const Json kNone;
  for (const auto& one : *at(answer.body, "parts").as<Json::Array>())
    if (text(one, "part") == id) return one;
  return kNone;
}

std::size_t openings(const Posted& answer, const std::string& id) {
  const auto* cutouts = at(part(answer, id), "answer/result").find("cutouts");
  return cutouts == nullptr ? 0 : cutouts->as<Json::Array>()->size();
}

/// A flat 60 x 20 is taller than a post of 50 is wide, but passes through it flat.
TEST(EverydayFrames, ARailPassesThroughThePostThatIsWiderAcrossBoth) {
  for (const bool turned : {false, true}) {
    const auto rails = turned ? rail(600, -600) : rail(-600, 600);
    for (const auto& joint : {through("rail", "post"), through("post", "rail")}) {
      const auto answer = post(kFrames, frame(kPost + "," + rails, joint));
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
      EXPECT_EQ(openings(answer, "post"), 2u);
      EXPECT_EQ(openings(answer, "rail"), 0u);
    }
  }
}

/// An end within the post is refused with the length that is missing.
TEST(EverydayFrames, ABarThatStopsShortOfAPostDoesNotPassThrough) {
  for (const auto& [from, missing] : {std::pair{-10.0, 15.0}, {0.0, 25.0}}) {
    const auto answer =
        post(kFrames, frame(kPost + "," + rail(from, 600), through("rail", "post")));
    ASSERT_TRUE(answer.outcome.error) << from;
    const auto& issue = at(answer.body, "errors/0");
    EXPECT_EQ(text(issue, "pointer"), "/joints/0/kind");
    EXPECT_EQ(text(issue, "code"), "joint_contradicts");
    EXPECT_NE(text(issue, "hint").find(" by " + std::to_string(static_cast<int>(missing)) + " mm"),
              std::string::npos)
        << text(issue, "hint");
  }
  // Flush with the far face, it passes.
  const auto flush = post(kFrames, frame(kPost + "," + rail(-25, 600), through("rail", "post")));
  EXPECT_FALSE(flush.outcome.error) << flush.outcome.body.substr(0, 800);
}

/// CAD splits a rail at each post that it passes through; merged, it is one bar again.
TEST(EverydayFrames, PiecesOfARailThatPassesThroughPostsAreMerged) {
  const auto members = kPost + "," + rail(-600, 0, "left") + "," + rail(0, 600, "right");
  for (const auto& joints :
       {through("left", "post") + "," + through("right", "post"), through("post", "left")}) {
    const auto asked = with(frame(members, joints), "merge_in_line", Json{true});
    const auto answer = post(kFrames, with(asked, "connect", parsed(R"({"within_mm": 1})")));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(at(answer.body, "result/members").as<Json::Array>()->size(), 2u);
    EXPECT_EQ(openings(answer, "post"), 2u);
  }
}

/// The same, whichever way each piece is drawn, in a model turned in plan and rounded to three
/// decimals, and listed in any order.
TEST(EverydayFrames, MergedPiecesDoNotDependOnHowTheyAreDrawn) {
  const double turn = 37.3 * kRadPerDeg;
  const auto turned = [&](Json asked) {
    for (std::size_t i = 0; i < 3; ++i)
      for (const auto* end : {"start_mm", "end_mm", "up"}) {
        const auto at_field = "members/" + std::to_string(i) + "/" + end;
        const auto v = numbers(at(asked, "members/" + std::to_string(i)), end);
        const auto tidy = [](double x) { return Json{std::round(x * 1e3) / 1e3}; };
        const double x = v[0] * std::cos(turn) - v[1] * std::sin(turn);
        const double y = v[0] * std::sin(turn) + v[1] * std::cos(turn);
        asked = with(asked, at_field, Json{Json::Array{tidy(x), tidy(y), tidy(v[2])}});
      }
    return asked;
  };
  const auto left = rail(-600, 0, "left"), right = rail(0, 600, "right");
  for (const auto& members : {kPost + "," + left + "," + right, right + "," + left + "," + kPost,
                              kPost + "," + rail(0, -600, "left") + "," + right,
                              rail(0, -600, "left") + "," + kPost + "," + rail(600, 0, "right")}) {
    auto asked = with(frame(members, through("left", "post") + "," + through("right", "post")),
                      "merge_in_line", Json{true});
    asked = turned(with(asked, "connect", parsed(R"({"within_mm": 1})")));
    const auto answer = post(kFrames, asked);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(at(answer.body, "result/members").as<Json::Array>()->size(), 2u);
    EXPECT_EQ(openings(answer, "post"), 2u);
    EXPECT_EQ(at(answer.body, "verification/passed"), Json{true});
  }
}

/// A limit holds where something is measured for it. Those of cut-outs are in every request of a
/// shop; others are refused if nothing is measured for them.
TEST(EverydayFrames, LimitsHoldForThePartsThatTheyAreMeasuredFor) {
  const std::string tube =
      R"({"id": "tube", "start_mm": [0, 300, 0], "end_mm": [0, 300, 900], "up": [1, 0, 0],
          "outer_diameter_mm": 42.4, "wall_mm": 3,
          "cutouts": [{"id": "bolt", "shape": {"kind": "circle", "diameter_mm": 12},
                       "at": {"z_mm": 100, "phi_deg": 0}}]})";
  const auto limits = parsed(R"({"min_web_mm": 3, "min_hole_to_end_mm": 5, "min_tongue_mm": 1,
                                 "min_diameter_mm": 8, "min_diameter_per_wall": 1})");
  const auto members = kPost + "," + rail(-600, 600) + "," + tube;
  const auto answer =
      post(kFrames, with(frame(members, through("rail", "post")), "accept", limits));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  for (const auto* id : {"post", "rail", "tube"})
    EXPECT_EQ(part(answer, id).find("problem"), nullptr) << api::dump(part(answer, id));
  EXPECT_EQ(text(answer.body, "verdict/status"), "ok");
  const auto strict = with(limits, "min_diameter_mm", Json{14.0});
  const auto small = post(kFrames, with(frame(members, through("rail", "post")), "accept", strict));
  EXPECT_EQ(text(small.body, "verdict/status"), "reject");
  // Without the tube there is no round member, and no cut-out.
  const auto none =
      post(kFrames,
           with(frame(kPost + "," + rail(-600, 600), through("rail", "post")), "accept", limits));
  ASSERT_TRUE(none.outcome.error);
  std::vector<std::string> at_fields;
  for (const auto& issue : *at(none.body, "errors").as<Json::Array>())
    at_fields.push_back(text(issue, "pointer"));
  EXPECT_EQ(at_fields, (std::vector<std::string>{"/accept/min_tongue_mm"}));
}

/// A rail of 25 m with a picket each 11 cm is one part.
TEST(EverydayFrames, ALongRailTakesAHoleForEachOfItsPickets) {
  constexpr int kPickets = 200;
  std::string members =
      R"({"id": "rail", "start_mm": [0, 0, 0], "end_mm": [25000, 0, 0], "up": [0, 0, 1],
          "size": "SHS 40x40x2 EN 10219", "priority": 1})";
  std::string joints;
  for (int i = 0; i < kPickets; ++i) {
    const auto x = std::to_string(200 + 110 * i), id = "picket " + std::to_string(i);
    members += R"(, {"id": ")" + id + R"(", "start_mm": [)" + x + R"(, 0, -50], "end_mm": [)" + x +
               R"(, 0, 900], "outer_diameter_mm": 16, "wall_mm": 1.5, "priority": 2})";
    joints += (i > 0 ? "," : "") + through(id, "rail");
  }
  const auto answer = post(kFrames, frame(members, joints));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(part(answer, "rail").find("problem"), nullptr)
      << api::dump(part(answer, "rail")).substr(0, 500);
  EXPECT_EQ(openings(answer, "rail"), static_cast<std::size_t>(2 * kPickets));
}

/// A brace that ends on a thick chord does not reach the thin tube that lies within its outline.
TEST(EverydayFrames, AChordThatOthersHideGetsNeitherHoleNorMark) {
  const std::string members =
      R"({"id": "chord", "start_mm": [-500, 0, 0], "end_mm": [500, 0, 0], "up": [0, 0, 1],
          "outer_diameter_mm": 114.3, "wall_mm": 5, "priority": 1},
         {"id": "stub", "start_mm": [0, -300, 0], "end_mm": [0, 300, 0], "up": [0, 0, 1],
          "outer_diameter_mm": 60.3, "wall_mm": 4, "priority": 2},
         {"id": "brace", "start_mm": [0, 0, 0], "end_mm": [0, 0, 600], "up": [1, 0, 0],
          "outer_diameter_mm": 48.3, "wall_mm": 4, "priority": 3})";
  const auto joints = std::string(R"({"between": ["chord", "stub"], "kind": "through"},
                     {"between": ["chord", "brace"], "kind": "set_on", "hole": "cut"},
                     {"between": ["stub", "brace"], "kind": "set_on", "hole": "cut"})");
  const auto answer = post(kFrames, frame(members, joints));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  const auto holes = [&](const char* id) {
    const auto* all = at(part(answer, id), "answer/result").find("holes");
    return all == nullptr ? 0 : all->as<Json::Array>()->size();
  };
  EXPECT_EQ(holes("chord"), 3u);  // two of the stub, one of the brace
  EXPECT_EQ(holes("stub"), 0u);
  const auto* marks = at(part(answer, "stub"), "answer/request").find("marks");
  EXPECT_EQ(marks, nullptr);
}

std::string square(const std::string& id, const std::string& from, const std::string& to,
                   const std::string& size, const std::string& up, int priority) {
  return R"({"id": ")" + id + R"(", "start_mm": )" + from + R"(, "end_mm": )" + to +
         R"(, "size": ")" + size + R"(", "up": )" + up + R"(, "priority": )" +
         std::to_string(priority) + "}";
}

/// Two rails that meet at a leg end at its faces and never at each other, so that all legs are one
/// part and all rails another, whoever was found to be near whom.
TEST(EverydayFrames, AStoolHasOneLegAndOneRail) {
  const std::vector<std::pair<int, int>> corners{{0, 0}, {400, 0}, {400, 400}, {0, 400}};
  std::string members;
  const auto point = [](const std::pair<int, int>& at, int z) {
    return "[" + std::to_string(at.first) + ", " + std::to_string(at.second) + ", " +
           std::to_string(z) + "]";
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& next = corners[(i + 1) % 4];
    members += (i > 0 ? "," : "") +
               square("leg" + std::to_string(i), point(corners[i], 0), point(corners[i], 450),
                      "SHS 40x40x3 EN 10219", "[1, 0, 0]", 1) +
               "," +
               square("rail" + std::to_string(i), point(corners[i], 200), point(next, 200),
                      "SHS 30x30x3 EN 10219", "[0, 0, 1]", 2);
  }
  const auto asked = with(frame(members, ""), "connect", parsed(R"({"within_mm": 1})"));
  const auto answer = post(kFrames, asked);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(at(answer.body, "parts").as<Json::Array>()->size(), 2u);
  EXPECT_EQ(at(answer.body, "result/joints").as<Json::Array>()->size(), 8u);
}

/// A table of legs and rails of one width, 800 x 500 mm, its rails at a height.
struct Table {
  std::string size;
  double width = 0.0;
  double height = 0.0;
  double turned = 0.0;  // deg, in plan
  bool rails_first = false;
  bool backwards = false;  // each second rail
};

std::string members_of(const Table& table) {
  const auto at = [&](int corner, double z) {
    const double x = corner == 1 || corner == 2 ? 800.0 : 0.0, y = corner >= 2 ? 500.0 : 0.0;
    const double c = std::cos(table.turned * kRadPerDeg), s = std::sin(table.turned * kRadPerDeg);
    const auto rounded = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
    return "[" + rounded(c * x - s * y) + ", " + rounded(s * x + c * y) + ", " + rounded(z) + "]";
  };
  const auto up = "[" + std::to_string(std::cos(table.turned * kRadPerDeg)) + ", " +
                  std::to_string(std::sin(table.turned * kRadPerDeg)) + ", 0]";
  std::string legs, rails;
  for (int i = 0; i < 4; ++i) {
    const auto name = std::to_string(i);
    legs += (i > 0 ? "," : "") + square("leg" + name, at(i, 0), at(i, 700), table.size, up, 1);
    const bool back = table.backwards && i % 2 == 1;
    const int from = back ? (i + 1) % 4 : i, to = back ? i : (i + 1) % 4;
    rails += (i > 0 ? "," : "") + square("rail" + name, at(from, table.height),
                                         at(to, table.height), table.size, "[0, 0, 1]", 1);
  }
  return table.rails_first ? rails + "," + legs : legs + "," + rails;
}

/// Rails as wide as the legs at whose corners they meet would run into each other in the rounding.
/// They end flat on the faces: two lengths, square at both ends, whatever the order and the place.
TEST(EverydayFrames, RailsAsWideAsTheirLegsEndFlatOnTheFaces) {
  for (const auto& table :
       {Table{"SHS 40x40x3 EN 10219", 40, 680}, Table{"SHS 40x40x3 EN 10219", 40, 660},
        Table{"SHS 40x40x3 EN 10219", 40, 300, 0, true},
        Table{"SHS 40x40x3 EN 10219", 40, 679.5, 0, false, true},
        Table{"SHS 40x40x3 EN 10219", 40, 300, 31.7},
        Table{"SHS 100x100x5 EN 10210", 100, 400, 12.3, true, true},
        Table{"SHS 50x50x5 EN 10219", 50, 675, 90}}) {
    const auto asked = with(frame(members_of(table), ""), "connect", parsed(R"({"within_mm": 1})"));
    const auto answer = post(kFrames, asked);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok") << table.height << " " << table.turned;
    std::multiset<double> lengths;
    for (const auto& row : *at(answer.body, "result/cut_list").as<Json::Array>()) {
      if (text(row, "part").starts_with("leg")) continue;
      lengths.insert(std::round(number(row, "long_mm") * 100.0) / 100.0);
      EXPECT_EQ(number(row, "count"), 2.0) << table.height << " " << table.turned;
      for (const auto* side : {"start", "finish"}) {
        const auto& end =
            at(part(answer, text(row, "part")), "answer/result/ends/" + std::string(side));
        const auto& z = *at(end, "points/z_outer_mm").as<Json::Array>();
        const auto [least, most] =
            std::ranges::minmax(z, {}, [](const Json& one) { return *one.as<double>(); });
        // Where the leg's outline ends, the cut drops by its sharp edge's radius.
        EXPECT_LT(*most.as<double>() - *least.as<double>(), 0.02) << table.height;
      }
    }
    EXPECT_EQ(lengths, (std::multiset<double>{500 - table.width, 800 - table.width}));
    bool told = false;
    for (const auto& warning : *at(answer.body, "warnings").as<Json::Array>())
      told = told || text(warning, "code") == "corner_shared";
    EXPECT_TRUE(told);
  }
}

/// The parts of such a table are the answers to their own requests, as a shop sends them next, in
/// mm and of sizes in inches, cut square or bevelled; the node tells the same.
TEST(EverydayFrames, FlatEndsAtASharedCornerAreThoseOfTheirOwnRequests) {
  const std::string bevelled =
      R"({"kerf_mm": 1.5, "sampling": {"tolerance_mm": 0.05}, "defaults": {"root_surface": "inner",
          "groove": {"rule": "half_dihedral"}, "smoothing": {"method": "none"},
          "contact": "auto"}, "members": [)";
  for (const bool square_cut : {true, false})
    for (const auto& table : {Table{"SHS 40x40x3 EN 10219", 40, 680, 31.7},
                              Table{"HSS 50.8x50.8x3.18 ASTM A500", 50.8, 600, 0, false, true}}) {
      const auto members = members_of(table);
      const auto plain = square_cut ? frame(members, "") : parsed(bevelled + members + "]}");
      const auto connect = parsed(R"({"within_mm": 1})");
      const auto answer = post(kFrames, with(plain, "connect", connect));
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
      for (const auto& one : *at(answer.body, "parts").as<Json::Array>()) {
        const auto again = post("/v1/parts", at(one, "answer/request"));
        ASSERT_FALSE(again.outcome.error) << again.outcome.body.substr(0, 800);
        EXPECT_EQ(text(again.body, "job/result_sha256"), text(one, "answer/job/result_sha256"))
            << table.size << " " << text(one, "part");
      }
      const auto node = post(
          "/v1/nodes", parsed(R"({"members": [)" + members + R"(], "connect": {"within_mm": 1}})"));
      ASSERT_FALSE(node.outcome.error) << node.outcome.body.substr(0, 800);
      std::size_t told = 0;
      for (const auto& warning : *at(node.body, "warnings").as<Json::Array>())
        told += text(warning, "code") == "corner_shared" ? 1 : 0;
      EXPECT_EQ(told, 8u) << table.size;
    }
}

/// A rafter on the beam that its post carries: the post ends under the beam, so the face that it
/// would have next to the rafter cuts nothing, whatever the last decimal of a turned model is.
TEST(EverydayFrames, ARafterEndsOnTheBeamAndNotOnThePostBelow) {
  for (const double turned : {0.0, 7.0, 15.5, 33.0, 61.3, 88.0}) {
    const auto at = [&](double x, double y, double z) { return turned_place(turned, x, y, z); };
    const auto members =
        square("beam", at(-300, 0, 2300), at(1000, 0, 2300), "RHS 150x100x5 EN 10219", "[0, 0, 1]",
               0) +
        "," +
        square("post", at(0, 0, 0), at(0, 0, 2300), "SHS 100x100x4 EN 10219",
               "[" + std::to_string(std::cos(turned * kRadPerDeg)) + ", " +
                   std::to_string(std::sin(turned * kRadPerDeg)) + ", 0]",
               1) +
        "," +
        square("rafter", at(0, 0, 2300), at(0, 3000, 2300), "RHS 80x40x3 EN 10219", "[0, 0, 1]", 2);
    const auto answer =
        post(kFrames, with(frame(members, ""), "connect", parsed(R"({"within_mm": 1})")));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok") << turned;
    for (const auto& joint : *testing::at(answer.body, "result/joints").as<Json::Array>())
      if (text(joint, "branch") == "rafter") {
        EXPECT_EQ(text(joint, "chord"), "beam") << turned;
        EXPECT_GT(number(joint, "weld_mm"), 200.0) << turned;
      }
  }
}

/// Rails as wide as one side of rectangular legs: flush with it, they end on the legs only, so that
/// the table has as many parts and joints turned in plan with three decimals as it has straight.
TEST(EverydayFrames, ATableTurnedInPlanHasTheSameJointsAndParts) {
  for (const auto& [leg, rail] : {std::pair{"RHS 60x40x3 EN 10219", "SHS 40x40x3 EN 10219"},
                                  std::pair{"SHS 60x60x3 EN 10219", "SHS 60x60x3 EN 10219"},
                                  std::pair{"RHS 80x40x3 EN 10219", "RHS 60x40x3 EN 10219"}})
    for (const double turned : {0.0, 10.0, 45.5, 301.18}) {
      const Table table{leg, 0, 400, turned};
      auto members = members_of(table);
      // Of those, the rails are the second half.
      const auto rails = members.find(R"({"id": "rail0")");
      auto changed = members.substr(rails);
      for (std::size_t at = changed.find(leg); at != std::string::npos;
           at = changed.find(leg, at + 1))
        changed.replace(at, std::string(leg).size(), rail);
      members = members.substr(0, rails) + changed;
      const auto answer =
          post(kFrames, with(frame(members, ""), "connect", parsed(R"({"within_mm": 5})")));
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
      for (const auto& joint : *at(answer.body, "result/joints").as<Json::Array>())
        EXPECT_TRUE(text(joint, "chord").starts_with("leg"))
            << leg << " " << turned << " " << text(joint, "branch") << text(joint, "chord");
      EXPECT_EQ(at(answer.body, "result/joints").as<Json::Array>()->size(), 8u) << turned;
      std::map<std::string, std::size_t> parts;
      for (const auto& row : *at(answer.body, "result/cut_list").as<Json::Array>())
        ++parts[text(row, "part").substr(0, 3)];
      EXPECT_EQ(parts["rai"], 2u) << leg << " " << turned;
    }
}

/// A post under the node of two rails in line and a third: the third ends at their side, so it does
/// not cut the post below them, although its lower face is flush with theirs.
TEST(EverydayFrames, APostUnderThreeRailsEndsOnThoseThatPassOverIt) {
  for (const double turned : {0.0, 33.3, 77.7, 123.4, 199.9, 245.6}) {
    const auto at = [&](double x, double y, double z) { return turned_place(turned, x, y, z); };
    const auto up = "[" + std::to_string(std::cos(turned * kRadPerDeg)) + ", " +
                    std::to_string(std::sin(turned * kRadPerDeg)) + ", 0]";
    const auto rail = [&](const std::string& id, const std::string& from, const std::string& to) {
      return square(id, from, to, "SHS 60x60x3 EN 10219", "[0, 0, 1]", 1);
    };
    const auto members =
        square("post", at(900, 0, 0), at(900, 0, 1500), "SHS 30x30x3 EN 10219", up, 1) + "," +
        rail("left", at(0, 0, 1500), at(900, 0, 1500)) + "," +
        rail("right", at(900, 0, 1500), at(1800, 0, 1500)) + "," +
        rail("across", at(900, 0, 1500), at(900, 400, 1500));
    const auto answer =
        post(kFrames, with(frame(members, ""), "connect", parsed(R"({"within_mm": 5})")));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    for (const auto& joint : *testing::at(answer.body, "result/joints").as<Json::Array>())
      EXPECT_FALSE(text(joint, "branch") == "post" && text(joint, "chord") == "across") << turned;
  }
}

/// A rail of 48.3 between legs of 40, which is wider than they are: it ends flat on their faces, so
/// that it is as long as the distance of the faces, whichever way it is drawn, listed and turned.
TEST(EverydayFrames, ARailWiderThanItsLegsEndsFlatOnTheirFaces) {
  for (const double turned : {0.0, 37.3})
    for (const double height : {400.0, 775.85})
      for (const bool rails_first : {false, true})
        for (const bool back : {false, true}) {
          const double c = std::cos(turned * kRadPerDeg), s = std::sin(turned * kRadPerDeg);
          const auto at = [&](double x, double z) {
            const auto rounded = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
            return "[" + rounded(c * x) + ", " + rounded(s * x) + ", " + rounded(z) + "]";
          };
          const auto up = "[" + std::to_string(c) + ", " + std::to_string(s) + ", 0]";
          std::string legs, rails;
          for (int i = 0; i < 3; ++i)
            legs += (i > 0 ? "," : "") + square("leg" + std::to_string(i), at(700.0 * i, 0),
                                                at(700.0 * i, 800), "SHS 40x40x3 EN 10219", up, 1);
          for (int i = 0; i < (height < 500.0 ? 2 : 1); ++i)
            rails += (i > 0 ? "," : "") + std::string(R"({"id": "rail)") + std::to_string(i) +
                     R"(", "start_mm": )" + at(700.0 * (back ? i + 1 : i), height) +
                     R"(, "end_mm": )" + at(700.0 * (back ? i : i + 1), height) +
                     R"(, "size": "CHS 48.3x3.2", "priority": 1})";
          const auto asked = frame(rails_first ? rails + "," + legs : legs + "," + rails, "");
          const auto answer = post(kFrames, with(asked, "connect", parsed(R"({"within_mm": 1})")));
          ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
          std::set<std::string> codes;
          for (const auto& w : *testing::at(answer.body, "warnings").as<Json::Array>())
            if (text(w, "severity") == "cut") codes.insert(text(w, "code"));
          // 4.15 mm of it lie past the face, on either side.
          EXPECT_EQ(codes, (std::set<std::string>{"wall_overhangs"})) << turned << " " << height;
          for (const auto& row : *testing::at(answer.body, "result/cut_list").as<Json::Array>())
            if (text(row, "part").starts_with("rail")) {
              EXPECT_NEAR(number(row, "long_mm"), 660.0, 0.01) << turned << " " << height;
            }
          for (const auto& joint : *testing::at(answer.body, "result/joints").as<Json::Array>())
            EXPECT_TRUE(text(joint, "chord").starts_with("leg")) << text(joint, "chord");
        }
}

/// The legs of an A-frame are mitred at its apex, whatever their angle, and a ridge beam between
/// two of them ends flat on their sides: no end is cut by another's missing metal.
TEST(EverydayFrames, ARidgeBeamEndsOnTheSidesOfItsAFrames) {
  for (const double turned : {0.0, 33.7})
    for (const double run : {300.0, 600.0, 1000.0})
      for (const int order : {0, 1, 2}) {
        const double c = std::cos(turned * kRadPerDeg), s = std::sin(turned * kRadPerDeg);
        const auto at = [&](double x, double y, double z) { return turned_place(turned, x, y, z); };
        const auto up = "[" + std::to_string(-s) + ", " + std::to_string(c) + ", 0]";
        std::vector<std::string> members;
        for (const int y : {0, 1500})
          for (const int side : {-1, 1})
            members.push_back(square("leg" + std::to_string(y + side), at(side * run, y, 0),
                                     at(0, y, 600), "SHS 40x40x3 EN 10219", up, 1));
        members.push_back(square("ridge", at(0, 0, 600), at(0, 1500, 600), "SHS 30x30x3 EN 10219",
                                 "[0, 0, 1]", 1));
        std::rotate(members.begin(), members.begin() + order, members.end());
        std::string all;
        for (const auto& one : members) all += (all.empty() ? "" : ",") + one;
        auto asked = with(frame(all, ""), "connect", parsed(R"({"within_mm": 1})"));
        const auto answer = post(kFrames, asked);
        ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
        for (const auto& w : *testing::at(answer.body, "warnings").as<Json::Array>())
          if (text(w, "severity") == "cut") {
            EXPECT_EQ(text(w, "code"), "root_opens") << run << " " << text(w, "detail");
          }
        for (const auto& row : *testing::at(answer.body, "result/cut_list").as<Json::Array>())
          if (text(row, "part") == "ridge") {
            EXPECT_NEAR(number(row, "long_mm"), 1460.0, 0.01);
          }
      }
}

/// A chord runs past the post that ends on it, by any length: that is no end that misses it.
TEST(EverydayFrames, AChordMayRunPastItsLastPost) {
  for (const int past : {20, 60, 100, 130, 200}) {
    const auto members =
        square("chord", "[0, 0, 0]", "[" + std::to_string(1000 + past) + ", 0, 0]",
               "SHS 80x80x4 EN 10219", "[0, 0, 1]", 1) +
        "," +
        square("post", "[1000, 0, 0]", "[1000, 0, 500]", "SHS 60x60x3 EN 10219", "[1, 0, 0]", 2);
    const auto answer =
        post(kFrames, with(frame(members, ""), "connect", parsed(R"({"within_mm": 1})")));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    for (const auto& warning : *at(answer.body, "warnings").as<Json::Array>())
      EXPECT_FALSE(text(warning, "code") == "free_end" && text(warning, "severity") == "cut")
          << past << " " << text(warning, "detail");
  }
}

/// Texts name the angle and the sizes that people mean.
TEST(EverydayFrames, RefusalsNameTheAngleAndTheSize) {
  const auto members =
      square("a", "[0, 0, 0]", "[500, 0, 0]", "SHS 40x40x3 EN 10219", "[0, 0, 1]", 1) + "," +
      square("b", "[500, 0, 0]", "[500, 400, 0]", "SHS 40x40x3 EN 10219", "[0, 0, 1]", 1);
  const auto butt = post(kFrames, frame(members, R"({"between": ["a", "b"], "kind": "butt"})"));
  ASSERT_TRUE(butt.outcome.error);
  EXPECT_EQ(text(butt.body, "errors/0/hint"), "the two lie 90 deg out of line; mitre them");
  for (const auto* name : {"SHS 50x50x3 EN10219", "shs50x50x3 en 10219", "SHS 50X50X3"}) {
    const auto near = post(kFrames, with(frame(members, ""), "members/0/size", Json{name}));
    ASSERT_TRUE(near.outcome.error);
    EXPECT_NE(text(near.body, "errors/0/hint").find("SHS 50x50x3 EN 10219"), std::string::npos)
        << name << text(near.body, "errors/0/hint");
  }
}

/// A tube laser's mitre stays open at its root, and a cut without contact enters its partner: both
/// are reported for square tubes as for round ones.
TEST(EverydayFrames, SquareTubesReportOpenRootsAndEnteredPartners) {
  const auto codes = [](const Json& asked) {
    const auto answer = post("/v1/bevel-tables", asked);
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    std::set<std::string> out;
    for (const auto& warning : *at(answer.body, "warnings").as<Json::Array>())
      out.insert(text(warning, "code"));
    return out;
  };
  for (const auto* tube :
       {R"({"size": "SHS 60x60x5 EN 10219"})", R"({"outer_diameter_mm": 60.3, "wall_mm": 5})"}) {
    auto asked = parsed(R"({"preset": "tube_laser", "kerf_mm": 0.2,
                            "cutters": [{"kind": "plane", "point_mm": [0, 0, 0],
                                         "normal": [0.7071067812, 0, 0.7071067812]}]})");
    asked = with(asked, "target", parsed(tube));
    EXPECT_TRUE(codes(asked).contains("root_opens")) << tube;
    EXPECT_TRUE(codes(with(asked, "contact", Json{"none"})).contains("enters_partner")) << tube;
    EXPECT_FALSE(codes(with(asked, "contact", Json{"none"})).contains("root_opens")) << tube;
  }
}

}  // namespace tubecut::testing::everyday_frames
