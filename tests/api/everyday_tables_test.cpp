// Tables as shops draw them: legs and rails of ordinary sizes, the rails flush with the legs' tops
// or below, ending at the legs' axes or at their faces, listed and drawn in any order, turned in
// plan.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::everyday_tables {

using api::Json;

constexpr double kLong = 800.0, kShort = 500.0, kTop = 700.0;

struct Bar {
  const char* section;  // fields of a member
  double height = 0.0;  // of a rail, mm
  double width = 0.0;
  bool round = false;
};
const std::vector<Bar> kLegs{{R"("size": "SHS 40x40x3 EN 10219")", 40, 40},
                             {R"("size": "SHS 50x50x3 EN 10219")", 50, 50},
                             {R"("outer_diameter_mm": 42.4, "wall_mm": 3)", 42.4, 42.4, true},
                             {R"("outer_diameter_mm": 60.3, "wall_mm": 3)", 60.3, 60.3, true}};
const std::vector<Bar> kRails{{R"("size": "RHS 60x40x3 EN 10219")", 60, 40},
                              {R"("size": "SHS 40x40x3 EN 10219")", 40, 40},
                              {R"("kind": "rectangular_tube", "height_mm": 40, "width_mm": 20,
                                  "wall_mm": 2, "corners": "en_10219")",
                               40, 20},
                              {R"("outer_diameter_mm": 33.7, "wall_mm": 3)", 33.7, 33.7, true},
                              {R"("outer_diameter_mm": 42.4, "wall_mm": 3)", 42.4, 42.4, true}};

struct Drawing {
  double turned = 0.0;   // deg, in plan
  bool at_face = false;  // rails end at the legs' faces, not at their axes
  double below = 0.0;    // the rails' tops, of the legs' tops, mm
  bool rails_first = false;
  bool backwards = false;  // each second rail
};

/// The request; coordinates have three decimals.
Json table_of(const Bar& leg, const Bar& rail, const Drawing& drawn) {
  const auto turn = drawn.turned * kRadPerDeg;
  const auto point = [&](double x, double y, double z) {
    const auto rounded = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
    return "[" + rounded(std::cos(turn) * x - std::sin(turn) * y) + ", " +
           rounded(std::sin(turn) * x + std::cos(turn) * y) + ", " + rounded(z) + "]";
  };
  const auto member = [&](const std::string& id, const std::string& from, const std::string& to,
                          const Bar& bar, const std::string& up) {
    return R"({"id": ")" + id + R"(", "start_mm": )" + from + R"(, "end_mm": )" + to + ", " +
           bar.section + (bar.round ? "" : R"(, "up": )" + up) + "}";
  };
  const double xs[]{0, kLong, kLong, 0}, ys[]{0, 0, kShort, kShort};
  const double z = kTop - drawn.below - 0.5 * rail.height;
  const double off = drawn.at_face ? 0.5 * leg.width : 0.0;
  std::vector<std::string> legs, rails;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto name = std::to_string(i);
    legs.push_back(member(
        "leg" + name, point(xs[i], ys[i], 0), point(xs[i], ys[i], kTop), leg,
        "[" + std::to_string(std::cos(turn)) + ", " + std::to_string(std::sin(turn)) + ", 0]"));
    const std::size_t next = (i + 1) % 4;
    const double length = i % 2 == 0 ? kLong : kShort;
    const double dx = (xs[next] - xs[i]) / length, dy = (ys[next] - ys[i]) / length;
    auto from = point(xs[i] + off * dx, ys[i] + off * dy, z);
    auto to = point(xs[next] - off * dx, ys[next] - off * dy, z);
    if (drawn.backwards && i % 2 == 1) std::swap(from, to);
    rails.push_back(member("rail" + name, from, to, rail, "[0, 0, 1]"));
  }
  auto all = drawn.rails_first ? rails : legs;
  const auto& then = drawn.rails_first ? legs : rails;
  all.insert(all.end(), then.begin(), then.end());
  std::string members;
  for (const auto& one : all) members += (members.empty() ? "" : ",") + one;
  return *api::parse(R"({"kerf_mm": 1, "connect": {"within_mm": 3}, "defaults": {
      "root_surface": "inner", "groove": {"rule": "none"}, "smoothing": {"method": "none"},
      "contact": "auto"}, "members": [)" +
                     members + "]}");
}

/// Legs as wide as the rails or wider carry them: they run to their tops, and each pair of opposite
/// rails is one part between them, no longer than from axis to axis, whichever size is the larger.
TEST(EverydayTables, LegsRunThroughAndOppositeRailsAreAlike) {
  int k = 0;
  for (const auto& leg : kLegs)
    for (const auto& rail : kRails) {
      if (rail.width > leg.width) continue;
      for (const double below : {0.0, 40.0})
        for (const bool at_face : {false, true}) {
          ++k;
          const Drawing drawn{.turned = k % 3 == 0 ? 0.0 : 17.31 * k,
                              .at_face = at_face,
                              .below = below,
                              .rails_first = k % 2 == 0,
                              .backwards = k % 5 < 2};
          const auto answer = post("/v1/frames", table_of(leg, rail, drawn));
          const auto which = std::string(leg.section) + rail.section + std::to_string(k);
          ASSERT_FALSE(answer.outcome.error) << which << answer.outcome.body.substr(0, 800);
          EXPECT_EQ(text(answer.body, "verdict/status"), "ok") << which;
          std::map<bool, int> count;
          for (const auto& row : *at(answer.body, "result/cut_list").as<Json::Array>()) {
            const bool is_leg = text(row, "part").starts_with("leg");
            count[is_leg] += static_cast<int>(number(row, "count"));
            const double length = number(row, "long_mm");
            if (is_leg) {
              EXPECT_NEAR(length, kTop, 1e-9) << which;
              continue;
            }
            EXPECT_EQ(number(row, "count"), 2.0) << which;
            const double axes = length > 650.0 ? kLong : kShort;
            EXPECT_LT(length, axes + 1e-3) << which;
            EXPECT_GT(length, axes - leg.width - 0.02) << which;
          }
          EXPECT_EQ(count[true], 4) << which;
          EXPECT_EQ(count[false], 4) << which;
        }
    }
}

/// Round rails that meet at a round leg end on it and at the plane between them, on the bore as by
/// the formulas of both, the leg being cut by neither.
TEST(EverydayTables, RoundRailsEndOnTheLegAndAtThePlaneBetweenThem) {
  const auto& leg = kLegs[2];
  for (const auto* rail : {&kRails[3], &kRails[4]})
    for (const bool at_face : {false, true}) {
      const double radius = 0.5 * leg.width, bore = 0.5 * rail->width - 3.0;
      const auto answer =
          post("/v1/frames", table_of(leg, *rail, {.at_face = at_face, .below = 60.0}));
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
      int ends = 0;
      for (const auto& one : *at(answer.body, "parts").as<Json::Array>()) {
        if (text(one, "part").starts_with("leg")) continue;
        for (const auto* side : {"start", "finish"}) {
          const auto& points = at(one, "answer/result/ends/" + std::string(side) + "/points");
          const auto& phi = *at(points, "phi_deg").as<Json::Array>();
          const auto& z = *at(points, "z_inner_mm").as<Json::Array>();
          const double sign = side[0] == 's' ? 1.0 : -1.0;
          double best = 1e300;  // of the turns by which phi is counted
          for (int turn = 0; turn < 4; ++turn) {
            double low = 1e300, high = -1e300;
            for (std::size_t i = 0; i < phi.size(); ++i) {
              const double towards =
                  bore * std::cos((*phi[i].as<double>() + 90.0 * turn) * kRadPerDeg);
              const double due = std::max(std::sqrt(radius * radius - towards * towards), towards);
              low = std::min(low, sign * *z[i].as<double>() - due);
              high = std::max(high, sign * *z[i].as<double>() - due);
            }
            best = std::min(best, high - low);
          }
          EXPECT_LT(best, 1e-9) << rail->width << " " << text(one, "part") << " " << side;
          ++ends;
        }
      }
      EXPECT_EQ(ends, 4);
    }
}

/// A note names the rail at whose plane each end ends; a stated joint of the two replaces it.
TEST(EverydayTables, ACornerMitreIsToldAndGivesWayToAStatedJoint) {
  auto asked = table_of(kLegs[2], kRails[3], {.below = 60.0});
  const auto told = [](const Posted& answer) {
    std::set<std::string> out;
    for (const auto& warning : *at(answer.body, "warnings").as<Json::Array>())
      if (text(warning, "code") == "corner_shared") out.insert(text(warning, "detail"));
    return out;
  };
  const auto found = post("/v1/frames", asked);
  ASSERT_FALSE(found.outcome.error) << found.outcome.body.substr(0, 800);
  EXPECT_EQ(told(found).size(), 4u);
  const auto stated = post(
      "/v1/frames",
      with(asked, "joints", *api::parse(R"([{"between": ["rail1", "rail0"], "kind": "set_on"}])")));
  ASSERT_FALSE(stated.outcome.error) << stated.outcome.body.substr(0, 800);
  std::multiset<std::string> kinds;
  for (const auto& joint : *at(stated.body, "result/joints").as<Json::Array>())
    if (text(joint, "branch") == "rail1" && text(joint, "chord") == "rail0")
      kinds.insert(text(joint, "kind"));
  EXPECT_EQ(kinds, std::multiset<std::string>{"set_on"});
  EXPECT_EQ(told(stated).count("mitred with rail0, because neither end can cut the other at this "
                               "corner"),
            1u);  // of rail3
}

/// Twelve centre-lines of a box of 600 x 400 x 500 mm. `order` shuffles the list and the ends.
Json box_of(const Bar& bar, double turned, int order) {
  const double turn = turned * kRadPerDeg, c = std::cos(turn), s = std::sin(turn);
  const double size[]{600, 400, 500};
  std::vector<std::string> all;
  for (int along = 0; along < 3; ++along)
    for (int k = 0; k < 4; ++k) {
      double from[3], to[3];
      for (int i = 0, bit = 0; i < 3; ++i)
        from[i] = to[i] = i == along ? 0.0 : ((k >> bit++) & 1) * size[i];
      to[along] = size[along];
      const auto point = [&](const double* p) {
        const auto shown = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
        return "[" + shown(c * p[0] - s * p[1]) + ", " + shown(s * p[0] + c * p[1]) + ", " +
               shown(p[2]) + "]";
      };
      const bool swapped = order > 0 && (along * 4 + k * order) % 3 == 1;
      const auto up = along == 2 ? "[" + std::to_string(c) + ", " + std::to_string(s) + ", 0]"
                                 : std::string("[0, 0, 1]");
      all.push_back(R"({"id": ")" + std::string(1, "xyz"[along]) + std::to_string(k) +
                    R"(", "start_mm": )" + point(swapped ? to : from) + R"(, "end_mm": )" +
                    point(swapped ? from : to) + ", " + bar.section +
                    (bar.round ? "" : R"(, "up": )" + up) + "}");
    }
  std::string members;
  for (std::size_t i = 0; i < all.size(); ++i)
    members += (i > 0 ? "," : "") + all[order == 0 ? i : (i * 5 + 3 * order) % all.size()];
  return *api::parse(R"({"kerf_mm": 1, "connect": {"within_mm": 3}, "defaults": {
      "root_surface": "inner", "groove": {"rule": "none"}, "smoothing": {"method": "none"},
      "contact": "auto"}, "members": [)" +
                     members + "]}");
}

/// The lengths of all members, each rounded to a hundredth.
std::multiset<double> lengths_of(const Posted& answer) {
  std::multiset<double> out;
  for (const auto& row : *at(answer.body, "result/cut_list").as<Json::Array>())
    for (int k = 0; k < static_cast<int>(number(row, "count")); ++k)
      out.insert(std::round(number(row, "long_mm") * 100.0) / 100.0);
  return out;
}

/// A box of square tubes by centre-lines: two mitred frames, and posts that end square between
/// them, in whatever order they are listed and drawn.
TEST(EverydayTables, ABoxIsTwoMitredFramesAndFourPosts) {
  std::multiset<double> due;
  for (int k = 0; k < 4; ++k) due.insert({640.0, 440.0, 460.0});
  for (int order = 0; order < 5; ++order) {
    const auto answer = post("/v1/frames", box_of(kLegs[0], 23.7 * order, order));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok") << order;
    EXPECT_EQ(lengths_of(answer), due) << order;
  }
}

/// Of round tubes a post has no flat face to end on, so each end of the box ends at the planes
/// between it and the two others: on the bore at the greater of both.
TEST(EverydayTables, ThreeRoundTubesMeetAtThePlanesBetweenThem) {
  const auto& bar = kLegs[2];
  const double bore = 0.5 * bar.width - 3.0;
  std::multiset<double> first;
  for (int order = 0; order < 4; ++order) {
    const auto answer = post("/v1/frames", box_of(bar, 31.0 * order, order));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok") << order;
    std::multiset<double> tenths;
    for (const double one : lengths_of(answer)) tenths.insert(std::round(one * 10.0) / 10.0);
    if (order == 0) first = tenths;
    EXPECT_EQ(tenths, first) << order;
    if (order > 0) continue;
    for (const auto& one : *at(answer.body, "parts").as<Json::Array>()) {
      const auto& points = at(one, "answer/result/ends/start/points");
      const auto& phi = *at(points, "phi_deg").as<Json::Array>();
      const auto& z = *at(points, "z_inner_mm").as<Json::Array>();
      double best = 1e300;  // of the turns by which phi is counted
      for (int turn = 0; turn < 4; ++turn) {
        double low = 1e300, high = -1e300;
        for (std::size_t i = 0; i < phi.size(); ++i) {
          const double at = (*phi[i].as<double>() + 90.0 * turn) * kRadPerDeg;
          const double off = *z[i].as<double>() - bore * std::max(std::cos(at), std::sin(at));
          low = std::min(low, off);
          high = std::max(high, off);
        }
        best = std::min(best, high - low);
      }
      EXPECT_LT(best, 1e-9) << text(one, "part");
    }
  }
}

/// The parts of mitred corners, and of posts that end flat on them, are the answers to their own
/// requests, as a shop sends them next.
TEST(EverydayTables, PartsOfABoxAreThoseOfTheirOwnRequests) {
  for (const auto* bar : {&kLegs[0], &kLegs[2]}) {
    const auto answer = post("/v1/frames", box_of(*bar, 23.7, 1));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    for (const auto& one : *at(answer.body, "parts").as<Json::Array>()) {
      const auto again = post("/v1/parts", at(one, "answer/request"));
      ASSERT_FALSE(again.outcome.error) << again.outcome.body.substr(0, 800);
      EXPECT_EQ(text(again.body, "job/result_sha256"), text(one, "answer/job/result_sha256"))
          << bar->section << " " << text(one, "part");
    }
  }
}

/// The legs of a pyramid are one part, whatever their order: each ends at the planes between it and
/// the others.
TEST(EverydayTables, LegsOfAPyramidMeetAtThePlanesBetweenThem) {
  const std::vector<std::string> feet{"[1000, 0, 0]", "[0, 1000, 0]", "[-1000, 0, 0]",
                                      "[0, -1000, 0]"};
  std::set<double> all;
  for (const auto& order : {std::vector<std::size_t>{0, 1, 2, 3}, {0, 2, 1, 3}, {3, 1, 0, 2}}) {
    std::string members;
    for (const auto i : order)
      members += (members.empty() ? "" : ",") + (R"({"id": "leg)" + std::to_string(i)) +
                 R"(", "start_mm": )" + feet[i] +
                 R"(, "end_mm": [0, 0, 1200], "size": "CHS 48.3x3.2"})";
    const auto answer = post("/v1/frames", *api::parse(R"({"kerf_mm": 1, "connect":
        {"within_mm": 3}, "defaults": {"root_surface": "inner", "groove": {"rule": "none"},
        "smoothing": {"method": "none"}, "contact": "auto"}, "members": [)" +
                                                       members + "]}"));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok");
    EXPECT_EQ(at(answer.body, "parts").as<Json::Array>()->size(), 1u);
    const auto lengths = lengths_of(answer);
    EXPECT_EQ(lengths.count(*lengths.begin()), 4u);
    EXPECT_GT(*lengths.begin(), std::hypot(1000.0, 1200.0));
    all.insert(*lengths.begin());
  }
  EXPECT_EQ(all.size(), 1u);
}

/// A brace larger than the two pieces of a run at whose butt it ends cuts one of them back, so that
/// the other's face meets nothing: that is told, whatever the order.
TEST(EverydayTables, APieceThatIsCutBehindTheButtLeavesTheOtherOpen) {
  const std::vector<std::string> all{
      R"({"id": "a", "start_mm": [-800, 0, 0], "end_mm": [0, 0, 0], "size": "CHS 33.7x2.6"})",
      R"({"id": "b", "start_mm": [0, 0, 0], "end_mm": [800, 0, 0], "size": "CHS 33.7x2.6"})",
      R"({"id": "k", "start_mm": [0, 0, 0], "end_mm": [500, 0, 500], "size": "CHS 60.3x3.2"})"};
  for (const auto& order : {std::vector<std::size_t>{0, 1, 2}, {2, 1, 0}, {1, 0, 2}}) {
    std::string members;
    for (const auto i : order) members += (members.empty() ? "" : ",") + all[i];
    const auto answer = post("/v1/frames", *api::parse(R"({"kerf_mm": 1, "connect":
        {"within_mm": 3}, "defaults": {"root_surface": "inner", "groove": {"rule": "none"},
        "smoothing": {"method": "none"}, "contact": "auto"}, "members": [)" +
                                                       members + "]}"));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    bool told = false;
    for (const auto& warning : *at(answer.body, "warnings").as<Json::Array>())
      told = told || (text(warning, "code") == "ghost_contact" &&
                      text(warning, "detail").find("behind that plane") != std::string::npos);
    EXPECT_TRUE(told) << answer.outcome.body.substr(0, 400);
    EXPECT_EQ(text(answer.body, "verdict/status"), "review");
  }
}

/// Rails whose outer faces are flush with those of a larger leg do not join each other, and share
/// its corner all the same.
TEST(EverydayTables, SmallRailsFlushWithTheFacesOfALargeLegShareItsCorner) {
  const auto answer = post("/v1/frames", *api::parse(R"({"preset": "tube_laser", "kerf_mm": 0.2,
      "connect": {"within_mm": 1}, "members": [
        {"id": "leg", "start_mm": [0, 0, 0], "end_mm": [0, 0, 1000], "up": [1, 0, 0],
         "size": "SHS 50x50x3 EN 10219"},
        {"id": "a", "start_mm": [0, 15, 500], "end_mm": [600, 15, 500], "up": [0, 0, 1],
         "size": "SHS 20x20x2 EN 10219"},
        {"id": "b", "start_mm": [15, 0, 500], "end_mm": [15, 600, 500], "up": [0, 0, 1],
         "size": "SHS 20x20x2 EN 10219"}]})"));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(text(answer.body, "verdict/status"), "ok");
  EXPECT_EQ(lengths_of(answer), (std::multiset<double>{575.0, 575.0, 1000.0}));
}

/// A truss whose braces are as deep as its chords has flush faces, and rounding decides there which
/// partner a generator meets. No turn in plan makes a warning or a part of that.
TEST(EverydayTables, FlushFacesOfATurnedTrussAreNoGhosts) {
  std::set<std::size_t> parts;
  for (const double turned : {0.0, 10.0, 33.3, 71.9}) {
    const double c = std::cos(turned * kRadPerDeg), s = std::sin(turned * kRadPerDeg);
    std::string members;
    const auto add = [&](const std::string& id, double x0, double z0, double x1, double z1,
                         int priority) {
      const auto shown = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
      const auto point = [&](double x, double z) {
        return "[" + shown(c * x) + ", " + shown(s * x) + ", " + shown(z) + "]";
      };
      members += (members.empty() ? "" : ",") + (R"({"id": ")" + id) + R"(", "start_mm": )" +
                 point(x0, z0) + R"(, "end_mm": )" + point(x1, z1) + R"(, "up": [)" +
                 std::to_string(-s) + ", " + std::to_string(c) +
                 R"(, 0], "size": "SHS 60x60x3 EN 10219", "priority": )" +
                 std::to_string(priority) + "}";
    };
    add("bottom", -30, 0, 1230, 0, 0);
    add("top", -30, 1000, 1230, 1000, 0);
    for (int i = 0; i < 4; ++i) {
      add("up" + std::to_string(i), 300 * i, 0, 300 * i + 150, 1000, 3);
      add("down" + std::to_string(i), 300 * i + 150, 1000, 300 * i + 300, 0, 4);
    }
    const auto answer =
        post("/v1/frames", *api::parse(R"({"preset": "tube_laser", "kerf_mm": 0.2, "connect":
            {"within_mm": 1}, "members": [)" +
                                       members + "]}"));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    for (const auto& warning : *at(answer.body, "warnings").as<Json::Array>())
      EXPECT_NE(text(warning, "code"), "ghost_contact") << turned << dump(warning);
    parts.insert(at(answer.body, "parts").as<Json::Array>()->size());
  }
  EXPECT_EQ(parts.size(), 1u);
}

/// Holes for branches in square tubes make two parts of one as little as other holes do: rungs
/// through stiles of a ladder that is turned in plan and written to three decimals.
TEST(EverydayTables, StilesOfATurnedLadderAreOnePart) {
  const double c = std::cos(30 * kRadPerDeg), s = std::sin(30 * kRadPerDeg);
  const auto shown = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
  for (const auto* rung :
       {R"("size": "CHS 26.9x2.6")", R"("size": "RHS 40x20x2 EN 10219", "up": [0, 0, 1])"}) {
    std::string members, joints;
    for (int i = 0; i < 2; ++i)
      members += R"({"id": "stile)" + std::to_string(i) + R"(", "start_mm": [)" +
                 shown(-400 * i * s) + "," + shown(400 * i * c) + R"(, 0], "end_mm": [)" +
                 shown(-400 * i * s) + "," + shown(400 * i * c) +
                 R"(, 1000], "size": "SHS 60x60x3 EN 10219", "up": [0.866025404, 0.5, 0]},)";
    for (int k = 0; k < 2; ++k) {
      const auto z = std::to_string(300 + 280 * k);
      members += (k > 0 ? "," : "") + (R"({"id": "rung)" + std::to_string(k)) +
                 R"(", "start_mm": [)" + shown(50 * s) + "," + shown(-50 * c) + "," + z +
                 R"(], "end_mm": [)" + shown(-450 * s) + "," + shown(450 * c) + "," + z + "], " +
                 rung + R"(, "priority": 1})";
      for (int i = 0; i < 2; ++i)
        joints += (joints.empty() ? "" : ",") + (R"({"between": ["rung)" + std::to_string(k)) +
                  R"(", "stile)" + std::to_string(i) + R"("], "kind": "through", "gap_mm": 0.5})";
    }
    const auto asked = [&](double within) {
      return *api::parse(R"({"preset": "tube_laser", "kerf_mm": 0.2, "members": [)" + members +
                         R"(], "joints": [)" + joints + R"(], "alike_within_mm": )" +
                         std::to_string(within) + "}");
    };
    const auto count = [&](double within) {
      const auto answer = post("/v1/frames", asked(within));
      EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
      return at(answer.body, "parts").as<Json::Array>()->size();
    };
    EXPECT_EQ(count(0.02), 2u) << rung;
    EXPECT_EQ(count(0.0), 3u) << rung;
  }
}

/// Three equal tubes meet at one node of a truss, in one plane: the outer two are mitred, and the
/// one between them ends on both. The list does not decide.
TEST(EverydayTables, ADiagonalInACornerEndsOnTheTwoMitredTubes) {
  const std::vector<std::string> all{
      R"({"id": "post", "start_mm": [0, 0, 0], "end_mm": [0, 0, 800],
          "size": "SHS 50x50x3 EN 10219", "up": [1, 0, 0]})",
      R"({"id": "diagonal", "start_mm": [0, 0, 0], "end_mm": [1000, 0, 800],
          "size": "SHS 50x50x3 EN 10219", "up": [0, 1, 0]})",
      R"({"id": "rail", "start_mm": [0, 0, 0], "end_mm": [2000, 0, 0],
          "size": "SHS 50x50x3 EN 10219", "up": [0, 0, 1]})"};
  std::vector<std::size_t> order{0, 1, 2};
  std::set<std::multiset<double>> lengths;
  do {
    std::string members;
    for (const auto i : order) members += (members.empty() ? "" : ",") + all[i];
    const auto answer = post("/v1/frames", *api::parse(R"({"kerf_mm": 1, "connect":
        {"within_mm": 2}, "defaults": {"root_surface": "inner", "groove": {"rule":
        "half_dihedral"}, "smoothing": {"method": "none"}, "contact": "auto"}, "members": [)" +
                                                       members + "]}"));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok");
    std::multiset<double> rounded;
    for (const double one : lengths_of(answer)) rounded.insert(std::round(one * 1e6) / 1e6);
    lengths.insert(rounded);
  } while (std::ranges::next_permutation(order).found);
  EXPECT_EQ(lengths.size(), 1u);
  EXPECT_LT(*lengths.begin()->rbegin(), 2025.0 + 1e-6) << "no tip stands out below the rail";
}

/// A purlin that lies on a beam touches it along a face and is cut by nothing: it has its part.
TEST(EverydayTables, ATubeThatLiesOnAnotherIsNotCutByIt) {
  const std::string beam = R"({"id": "beam", "start_mm": [0, 0, 0], "end_mm": [2000, 0, 0],
      "size": "RHS 100x50x4 EN 10219", "up": [0, 1, 0]})";
  const auto purlin = [](double z, const std::string& section) {
    const auto height = std::to_string(z);
    return R"({"id": "purlin", "start_mm": [500, 0, )" + height + R"(], "end_mm": [500, 1500, )" +
           height + "], " + section + "}";
  };
  for (const auto& one : {purlin(50, R"("size": "SHS 50x50x3 EN 10219", "up": [0, 0, 1])"),
                          purlin(41.85, R"("outer_diameter_mm": 33.7, "wall_mm": 3)")})
    for (const bool first : {true, false}) {
      const auto answer =
          post("/v1/frames", *api::parse(R"({"preset": "tube_laser", "kerf_mm": 0.2, "connect":
              {"within_mm": 2}, "members": [)" +
                                         (first ? beam : one) + "," + (first ? one : beam) + "]}"));
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
      EXPECT_EQ(at(answer.body, "parts").as<Json::Array>()->size(), 2u);
      EXPECT_NEAR(*lengths_of(answer).begin(), 1500.0, 1e-9);
      EXPECT_EQ(answer.outcome.body.find("no_contact"), std::string::npos);
      EXPECT_EQ(answer.outcome.body.find("end_open"), std::string::npos);
    }
}

/// Coordinates with three decimals turn the side faces of a chord that stand along the brace by a
/// hair: a generator that grazes one meets it over all its width, or only at its corner.
TEST(EverydayTables, FacesThatStandAlmostAlongTheTubeAreMetWhereTheyAre) {
  const auto ask = [](const std::string& cutters, double diameter) {
    return post("/v1/intersections",
                *api::parse(R"({"target": {"wall_mm": 3, "outer_diameter_mm": )" +
                            std::to_string(diameter) + R"(}, "sampling": {"tolerance_mm": 0.02},
                           "cutters": [)" +
                            cutters + "]}"));
  };
  for (const char* t : {"0", "1e-17", "3e-16", "1e-13", "1e-10", "1.8928e-08", "1e-7",
                        "1.765972e-06", "-1.765972e-06", "2e-5"}) {
    const std::string tilt = t, minus = t[0] == '-' ? tilt.substr(1) : "-" + tilt;
    const auto truss = ask(R"({"kind": "rectangular_tube", "width_mm": 40, "height_mm": 60,
          "corner_radius_mm": 6, "up": [0, -0.464828407376, -0.885400785904],
          "axis": {"point_mm": [0, 0, 0],
                   "direction": [)" +
                               tilt + R"(, 0.885400785914, -0.464828407372]}},
         {"kind": "plane", "point_mm": [0, 17.711602, -9.298451],
          "normal": [)" + minus +
                               ", -0.885400785914, 0.464828407372]}",
                           41.9);
    EXPECT_FALSE(truss.outcome.error) << tilt << truss.outcome.body.substr(0, 600);
    const auto corner = ask(R"({"kind": "tube", "outer_diameter_mm": 48.26,
          "inclination_deg": 50.1944258746, "clocking_deg": 180, "offset_mm": 0, "height_mm": 0},
         {"kind": "rectangular_tube", "width_mm": 30, "height_mm": 30, "corner_radius_mm": 4,
          "axis": {"point_mm": [0, 0, 0],
                   "direction": [)" +
                                tilt + R"(, -0.640184440333, 0.768221245707]}, "up": [1, 0, 0]})",
                            41.9);
    EXPECT_FALSE(corner.outcome.error) << tilt << corner.outcome.body.substr(0, 600);
  }
}

/// A truss of round diagonals nearly as wide as its chords, turned in plan: three decimals leave
/// the chords' sides 1e-7 to 1e-5 rad off the diagonals. None is a fault of the service.
TEST(EverydayTables, DiagonalsAsWideAsTheirChordsAreNoFaultsInATurnedModel) {
  for (int k = 0; k < 12; ++k) {
    const double turn = 0.5236 * k + 0.1378;
    const auto place = [&](double x, double z) {
      const auto text = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
      return "[" + text(1234.567 + std::cos(turn) * x) + "," + text(12.183 + std::sin(turn) * x) +
             "," + text(z) + "]";
    };
    const auto member = [&](const std::string& id, double x, double z, double to_x, double to_z,
                            const char* size) {
      return R"({"id": ")" + id + R"(", "start_mm": )" + place(x, z) + R"(, "end_mm": )" +
             place(to_x, to_z) + ", " + size + "}";
    };
    const char *chord = R"("size": "RHS 60x40x3 EN 10219", "up": [0, 0, 1])",
               *brace = R"("size": "CHS 48.3x3.2")";
    const auto answer =
        post("/v1/frames",
             *api::parse(R"({"preset": "tube_laser", "kerf_mm": 0.2, "connect": {"within_mm": 5},
                        "sampling": {"tolerance_mm": 0.05}, "members": [)" +
                         member("bot", 0, 0, 2000, 0, chord) + "," +
                         member("top", 0, 500, 2000, 500, chord) + "," +
                         member("d1", 366.7, 500, 640, 0, brace) + "," +
                         member("d2", 700, 0, 973.3, 500, brace) + "," +
                         member("d3", 1033.3, 500, 1306.7, 0, brace) + "]}"));
    ASSERT_FALSE(answer.outcome.error) << k << answer.outcome.body.substr(0, 600);
    // A diagonal that is wider than its chord may be refused as open, never as a fault.
    EXPECT_EQ(answer.outcome.body.find("verification_failed"), std::string::npos) << k;
    EXPECT_EQ(answer.outcome.body.find("internal_error"), std::string::npos) << k;
  }
}

}  // namespace tubecut::testing::everyday_tables
