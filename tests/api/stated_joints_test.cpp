// Joints as people state them: in either order, at a crossing, with a wrong id, and in models with
// one decimal.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::stated_joints {

using api::Json;

constexpr const char* kFrames = "/v1/frames";

struct Bar {
  std::string id;
  double from[3], to[3];
};

std::string point(const double (&p)[3]) {
  return "[" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " + std::to_string(p[2]) +
         "]";
}

/// SHS 40, or CHS 42.4.
std::string member(const Bar& bar, bool round = false) {
  return R"({"id": ")" + bar.id + R"(", "start_mm": )" + point(bar.from) + R"(, "end_mm": )" +
         point(bar.to) +
         (round ? R"(, "outer_diameter_mm": 42.4, "wall_mm": 2.6})"
                : R"(, "size": "SHS 40x40x3 EN 10219", "up": [0, 0, 1]})");
}

Posted frame(const std::vector<std::string>& members, const std::string& rest) {
  std::string all;
  for (const auto& one : members) all += (all.empty() ? "" : ", ") + one;
  const std::string body =
      R"({"preset": "tube_laser", "kerf_mm": 0.2, "members": [)" + all + "], " + rest + "}";
  return post(kFrames, std::string_view(body));
}

std::string joint(const char* a, const char* b, const char* kind) {
  return R"("joints": [{"between": [")" + std::string(a) + R"(", ")" + b + R"("], "kind": ")" +
         kind + R"("}])";
}

double length_of(const Posted& answer, const std::string& part) {
  for (const auto& row : *at(answer.body, "result/cut_list").as<Json::Array>())
    if (text(row, "part") == part) return number(row, "long_mm");
  return 0.0;
}

std::vector<std::string> codes(const Posted& answer) {
  std::vector<std::string> out;
  for (const auto& one : *at(answer.body, "warnings").as<Json::Array>())
    out.push_back(text(one, "code"));
  return out;
}

/// The rail that ends on the chord is cut, whichever is named or listed first.
TEST(StatedJoints, OfTwoAlikeTheOneThatEndsOnTheOtherIsTheBranch) {
  const Bar rail{"rail", {500, 0, 0}, {500, 600, 0}}, chord{"chord", {0, 0, 0}, {1200, 0, 0}};
  for (const bool round : {false, true})
    for (const bool rail_first : {false, true})
      for (const auto& said :
           {joint("rail", "chord", "set_on"), joint("chord", "rail", "set_on")}) {
        auto members = std::vector{member(rail, round), member(chord, round)};
        if (!rail_first) std::swap(members[0], members[1]);
        const auto answer = frame(members, said);
        ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
        EXPECT_NEAR(length_of(answer, "chord"), 1200.0, 1e-6);
        EXPECT_LT(length_of(answer, "rail"), 600.0);
        EXPECT_GT(length_of(answer, "rail"), 575.0);
      }
}

/// Far from any end, a stated joint would cut off half a member, or add half a metre.
TEST(StatedJoints, AJointFarFromAnyEndIsRefused) {
  const Bar a{"a", {0, 0, 0}, {1000, 0, 0}};
  const Bar crossing{"b", {500, -400, 0}, {500, 400, 0}}, tee{"b", {500, 0, 0}, {500, 400, 0}},
      far{"b", {1500, 0, 0}, {1500, 400, 0}}, in_line{"b", {1100, 0, 0}, {2000, 0, 0}};
  struct Case {
    const Bar& other;
    const char* kind;
  };
  for (const auto& [other, kind] : {Case{crossing, "set_on"},
                                    {crossing, "set_in"},
                                    {crossing, "mitre"},
                                    {tee, "mitre"},
                                    {far, "mitre"},
                                    {far, "set_on"},
                                    {in_line, "butt"}}) {
    const auto answer = frame({member(a), member(other)}, joint("a", "b", kind));
    ASSERT_TRUE(answer.outcome.error) << kind;
    const auto& issue = at(answer.body, "errors/0");
    EXPECT_EQ(text(issue, "code"), "no_contact") << kind;
    EXPECT_EQ(text(issue, "pointer"), "/joints/0");
    EXPECT_GT(number(issue, "got"), number(issue, "limit"));
  }
  // Drawn to the face instead of the axis, with some millimetres of play, they are answered.
  const Bar to_face{"b", {1000, 25, 0}, {1000, 400, 0}}, next{"b", {1005, 0, 0}, {2000, 0, 0}};
  for (const auto& [other, kind] :
       {Case{to_face, "set_on"}, {to_face, "mitre"}, {next, "butt"}, {next, "mitre"}}) {
    const auto answer = frame({member(a), member(other)}, joint("a", "b", kind));
    EXPECT_FALSE(answer.outcome.error) << kind << answer.outcome.body.substr(0, 600);
  }
}

/// Pickets in front of their rails, and tubes that lie on each other, end next to a member that
/// they touch; a brace that is too short does not.
TEST(StatedJoints, AnEndBesideAMemberThatItTouchesIsNotFree) {
  for (const int within : {1, 5, 10, 20}) {
    const auto connect = R"("connect": {"within_mm": )" + std::to_string(within) + "}";
    const Bar upper{"upper", {0, 0, 40}, {1000, 0, 40}}, lower{"lower", {0, 0, 0}, {1000, 0, 0}};
    const auto doubled = frame({member(lower), member(upper)}, connect);
    ASSERT_FALSE(doubled.outcome.error) << doubled.outcome.body.substr(0, 600);
    EXPECT_EQ(codes(doubled), std::vector<std::string>()) << within;
    const Bar picket{"picket", {500, 40, -100}, {500, 40, 400}};
    const auto fence = frame({member(lower),
                              R"({"id": "p", "start_mm": [500, 40, -100], "end_mm": [500, 40, 400],
                                  "size": "SHS 40x40x3 EN 10219", "up": [0, 1, 0]})"},
                             connect);
    ASSERT_FALSE(fence.outcome.error) << fence.outcome.body.substr(0, 600);
    EXPECT_EQ(codes(fence), std::vector<std::string>()) << within;
    const Bar brace{"brace", {500, 60, 0}, {500, 600, 0}};  // 40 mm short of the face
    const auto missed = frame({member(lower), member(brace)}, connect);
    ASSERT_FALSE(missed.outcome.error) << missed.outcome.body.substr(0, 600);
    if (within == 10) {
      EXPECT_EQ(codes(missed), std::vector<std::string>{"free_end"});
      EXPECT_NE(text(missed.body, "warnings/0/detail").find("by 40 mm"), std::string::npos);
    }
  }
}

/// A ladder and a table as a CAD writes them: turned in plan, coordinates with one decimal.
TEST(StatedJoints, OneDecimalDecidesNoVerdict) {
  for (const double turn : {0.0, 15.0, 33.0, 45.0, 77.7}) {
    const double cos = std::cos(turn * kRadPerDeg), sin = std::sin(turn * kRadPerDeg);
    const auto rounded = [](double v) { return std::round(10.0 * v) / 10.0; };
    const auto turned = [&](const std::string& id, double x, double y, double z, double u, double v,
                            double w) {
      return Bar{id,
                 {rounded(cos * x - sin * y), rounded(sin * x + cos * y), z},
                 {rounded(cos * u - sin * v), rounded(sin * u + cos * v), w}};
    };
    std::vector<std::string> members{member(turned("left", 0, 0, 0, 1200, 0, 0)),
                                     member(turned("right", 0, 333.3, 0, 1200, 333.3, 0))};
    for (int i = 0; i < 4; ++i)
      members.push_back(member(turned("rung " + std::to_string(i), 150.0 + 300.0 * i, 0, 0,
                                      150.0 + 300.0 * i, 333.3, 0)));
    const auto answer = frame(members, R"("connect": {"within_mm": 5})");
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok")
        << turn << answer.outcome.body.substr(0, 0);
  }
}

/// Of an end's warnings the frame repeats the worst: "by up to" holds for the part.
TEST(StatedJoints, TheFrameRepeatsThePartsWorstWarning) {
  const Bar base{"base", {0, 0, 0}, {1000, 0, 0}}, post{"post", {1000, 0, 0}, {1000, 0, 400}};
  const std::string brace =
      R"({"id": "brace", "start_mm": [300, 0, 0], "end_mm": [1000, 0, 300], "size": "SHS 40x40x3 EN 10219",
          "up": [0, 1, 0]})";
  const auto answer = frame({member(base),
                             R"({"id": "post", "start_mm": [1000, 0, 0], "end_mm": [1000, 0, 400],
                                 "size": "SHS 40x40x3 EN 10219", "up": [1, 0, 0]})",
                             brace},
                            R"("connect": {"within_mm": 5})");
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
  const auto stated = [](const Json& warning) {
    const auto detail = text(warning, "detail");
    const auto from = detail.find("by up to ");
    return from == std::string::npos ? 0.0 : std::stod(detail.substr(from + 9));
  };
  int parts_with = 0;
  for (const auto& part : *at(answer.body, "parts").as<Json::Array>()) {
    double worst = 0.0;
    for (const auto& one : *at(part, "answer/warnings").as<Json::Array>())
      if (text(one, "code") == "root_opens") worst = std::max(worst, stated(one));
    if (worst == 0.0) continue;
    ++parts_with;
    const auto begins = "part " + text(part, "part") + " at";
    for (const auto& one : *at(answer.body, "warnings").as<Json::Array>())
      if (text(one, "code") == "root_opens" && text(one, "detail").starts_with(begins)) {
        EXPECT_EQ(stated(one), worst);
      }
  }
  EXPECT_GT(parts_with, 0);
}

/// People draw an end to the axis, to the near face or to the far one, and a model is turned in
/// plan and rounded to three decimals: the part stays the same length, counted from its free end.
TEST(StatedJoints, WhereAnEndIsDrawnChangesNoPart) {
  struct Sizes {
    const char *chord, *branch;
    double face;  // from the chord's axis, mm
  };
  for (const auto& [chord, branch, face] :
       {Sizes{"SHS 100x100x5 EN 10219", "SHS 40x40x3 EN 10219", 50.0},
        Sizes{"CHS 168.3x8", "CHS 48.3x3.2", 84.15}, Sizes{"CHS 114.3x5", "CHS 114.3x5", 57.15},
        Sizes{"SHS 40x40x3 EN 10219", "SHS 40x40x3 EN 10219", 20.0}})
    for (const char* kind : {"set_on", "mitre"})
      for (const double turn : {0.0, 33.3}) {
        const double cos = std::cos(turn * kRadPerDeg), sin = std::sin(turn * kRadPerDeg);
        const auto at = [&](double x, double y) {
          const auto rounded = [](double v) { return std::to_string(std::round(1e3 * v) / 1e3); };
          return "[" + rounded(cos * x - sin * y) + ", " + rounded(sin * x + cos * y) + ", 0]";
        };
        const auto bar = [&](const char* id, const char* size, const std::string& from,
                             const std::string& to) {
          return R"({"id": ")" + std::string(id) + R"(", "size": ")" + size +
                 R"(", "up": [0, 0, 1], "start_mm": )" + from + R"(, "end_mm": )" + to + "}";
        };
        // A T for set_on; for a mitre the chord ends where the branch meets it.
        const bool tee = kind == std::string("set_on");
        std::vector<double> lengths;
        for (const double drawn : {0.0, face, -face})
          for (const bool reversed : {false, true}) {
            const auto root = at(500.0, drawn), free = at(500.0, 700.0);
            const auto answer = frame(
                {bar("chord", chord, at(0.0, 0.0), at(tee ? 1000.0 : 500.0, 0.0)),
                 reversed ? bar("branch", branch, free, root) : bar("branch", branch, root, free)},
                joint("branch", "chord", kind));
            ASSERT_FALSE(answer.outcome.error)
                << branch << kind << drawn << answer.outcome.body.substr(0, 600);
            lengths.push_back(length_of(answer, "branch"));
            if (tee) {
              EXPECT_NEAR(length_of(answer, "chord"), 1000.0, 2e-3) << branch;
            }
          }
        const auto [least, most] = std::ranges::minmax(lengths);
        EXPECT_LT(most - least, 0.02) << branch << " " << kind << " turned by " << turn;
      }
}

/// The way out for a member wider than its partner is told for its ends only.
TEST(StatedJoints, AWiderMemberIsToldTheWayOut) {
  const auto post = [](const std::string& more) {
    return R"({"id": "post", "start_mm": [500, 0, -600], "end_mm": [500, 0, 0], "up": [1, 0, 0],
               "size": "SHS 50x50x3 EN 10219", "priority": 2)" +
           more + "}";
  };
  const auto no_part = [](const Posted& answer) {
    for (const auto& one : *at(answer.body, "warnings").as<Json::Array>())
      if (text(one, "code") == "no_part") return text(one, "detail");
    return std::string();
  };
  const std::string beam =
      R"({"id": "beam", "start_mm": [0, 0, 0], "end_mm": [1000, 0, 0],
          "outer_diameter_mm": 42.4, "wall_mm": 3, "priority": 1})";
  const auto open = frame({beam, post("")}, joint("post", "beam", "set_on"));
  ASSERT_FALSE(open.outcome.error) << open.outcome.body.substr(0, 600);
  EXPECT_NE(no_part(open).find("lower priority number"), std::string::npos) << no_part(open);
  const std::string window =
      R"({"id": "beam", "start_mm": [0, 0, 0], "end_mm": [1000, 0, 0], "up": [0, 0, 1], "outer_diameter_mm": 48.3, "wall_mm": 3.2,
          "cutouts": [{"id": "w", "shape": {"kind": "rectangle", "along_mm": 60, "round_mm": 47}, "wall": "normal",
                       "at": {"z_mm": 300, "phi_deg": 0}}]})";
  const auto wide =
      frame({window, R"({"id": "rail", "start_mm": [500, 0, 0], "end_mm": [500, 400, 0],
                                       "outer_diameter_mm": 33.7, "wall_mm": 2.6})"},
            joint("rail", "beam", "set_on"));
  const auto told = wide.outcome.error ? wide.outcome.body : no_part(wide);
  EXPECT_NE(told.find("open_profile"), std::string::npos) << told.substr(0, 600);
  EXPECT_EQ(told.find("lower priority number"), std::string::npos) << told.substr(0, 600);
}

}  // namespace tubecut::testing::stated_joints
