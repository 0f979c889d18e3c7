// Frames in which an end's cut edge has a step, because it goes over from one partner to another
// where a generator runs within a partner's side. No figure depends on how the member's own frame
// is drawn: a reversed `up` turns every frame by half, a mirrored model reverses every direction
// around a tube.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::step_frames {

using api::Json;
using Place = std::array<double, 3>;

struct Member {
  std::string id;
  Place start, finish;
  std::string shape;
  Place up;
};
struct Model {
  std::string name, options;
  std::vector<Member> members;
};

std::string box(int height, int width, int wall, const std::string& corners, int priority) {
  return R"("kind": "rectangular_tube", "height_mm": )" + std::to_string(height) +
         R"(, "width_mm": )" + std::to_string(width) + R"(, "wall_mm": )" + std::to_string(wall) +
         R"(, "corners": ")" + corners + R"(", "priority": )" + std::to_string(priority);
}

constexpr const char* kTorch =
    R"("connect": {"within_mm": 10}, "kerf_mm": 1, "sampling": {"tolerance_mm": 0.05},
       "defaults": {"root_surface": "inner", "groove": {"rule": "none"},
                    "smoothing": {"method": "none"}, "contact": "auto"})";
constexpr const char* kLaser =
    R"("connect": {"within_mm": 5}, "kerf_mm": 0.2, "sampling": {"tolerance_mm": 0.05},
       "preset": "tube_laser")";

/// A gate's brace in the corner of post and rail.
Model gate() {
  return {"gate",
          kTorch,
          {{"post", {0, 0, 0}, {0, 0, 800}, box(80, 60, 4, "en_10219", 0), {0, 1, 0}},
           {"bottom", {0, 0, 0}, {1200, 0, 0}, box(60, 40, 3, "en_10219", 2), {0, 0, 1}},
           {"brace", {0, 0, 0}, {1200, 0, 800}, box(80, 60, 4, "en_10219", 4), {0, 1, 0}}}};
}

/// Two braces that meet under a chord, wider than it.
Model truss() {
  const auto brace = box(80, 60, 4, "en_10219", 1);
  return {"truss",
          kTorch,
          {{"chord", {-100, 0, 600}, {1900, 0, 600}, box(100, 50, 4, "en_10219", 0), {0, 0, 1}},
           {"one", {30, 0, 0}, {270, 0, 600}, brace, {0, 1, 0}},
           {"two", {330, 0, 600}, {570, 0, 0}, brace, {0, 1, 0}}}};
}

/// A brace of 80 across post and rail of 40, for a laser.
Model laser_brace() {
  return {"laser brace",
          kLaser,
          {{"post", {0, 0, 0}, {0, 0, 1000}, box(60, 40, 3, "en_10219", 0), {0, 1, 0}},
           {"bottom", {0, 0, 100}, {900, 0, 100}, box(60, 40, 3, "en_10219", 2), {0, 0, 1}},
           {"brace", {0, 0, 100}, {900, 0, 1000}, box(60, 80, 4, "en_10210", 4), {0, 1, 0}}}};
}

/// A sawhorse's two legs under a thin ridge.
Model sawhorse() {
  return {"sawhorse",
          kLaser,
          {{"ridge", {-50, 0, 750}, {950, 0, 750}, box(25, 25, 2, "en_10210", 0), {0, 0, 1}},
           {"one", {-70, -300, 0}, {50, 0, 750}, box(60, 60, 4, "en_10219", 1), {1, 0, 0}},
           {"two", {-70, 300, 0}, {50, 0, 750}, box(60, 60, 4, "en_10219", 2), {1, 0, 0}}}};
}

Model with_ups_reversed(Model model) {
  for (auto& member : model.members)
    for (double& x : member.up) x = -x;
  return model;
}
Model mirrored(Model model) {
  for (auto& member : model.members)
    for (auto* place : {&member.start, &member.finish, &member.up}) (*place)[1] = -(*place)[1];
  return model;
}
/// Turned in plan, in mm with three decimals.
Model turned(Model model, double degrees) {
  const double c = std::cos(degrees * kRadPerDeg), s = std::sin(degrees * kRadPerDeg);
  const auto turn = [&](Place p, double unit) {
    const auto rounded = [unit](double v) { return unit > 0.0 ? std::round(v / unit) * unit : v; };
    return Place{rounded(c * p[0] - s * p[1]), rounded(s * p[0] + c * p[1]), p[2]};
  };
  for (auto& member : model.members) {
    member.start = turn(member.start, 1e-3);
    member.finish = turn(member.finish, 1e-3);
    member.up = turn(member.up, 0.0);
  }
  return model;
}

Posted made(const Model& model) {
  const auto place = [](const Place& p) {
    const auto coordinate = [](double x) { return api::dump(Json(x)); };
    return "[" + coordinate(p[0]) + ", " + coordinate(p[1]) + ", " + coordinate(p[2]) + "]";
  };
  std::string members;
  for (const auto& m : model.members)
    members += (members.empty() ? "" : ", ") + std::string(R"({"id": ")") + m.id +
               R"(", "start_mm": )" + place(m.start) + R"(, "end_mm": )" + place(m.finish) +
               R"(, "up": )" + place(m.up) + ", " + m.shape + "}";
  const std::string request = "{" + model.options + R"(, "members": [)" + members + "]}";
  auto out = post("/v1/frames", std::string_view(request));
  EXPECT_FALSE(out.outcome.error) << model.name << out.outcome.body.substr(0, 800);
  return out;
}

/// The answer of the part that a member is.
const Json& part_of(const Posted& answer, const std::string& member) {
  static const Json kNone;
  std::string name;
  for (const auto& one : *at(answer.body, "result/members").as<Json::Array>())
    if (text(one, "id") == member) name = text(one, "part");
  for (const auto& one : *at(answer.body, "parts").as<Json::Array>())
    if (text(one, "part") == name) return at(one, "answer/result");
  return kNone;
}

/// Every figure that a member's own frame must not change, by name.
std::map<std::string, double> figures(const Model& model) {
  const auto answer = made(model);
  std::map<std::string, double> out;
  for (const auto& joint : *at(answer.body, "result/joints").as<Json::Array>())
    if (joint.find("weld_mm") != nullptr)
      out[text(joint, "branch") + " on " + text(joint, "chord")] = number(joint, "weld_mm");
  for (const auto& member : model.members) {
    const auto& part = part_of(answer, member.id);
    for (const char* length : {"long_mm", "short_mm", "blank_mm", "weld_mm"})
      out[member.id + " " + length] = number(part, std::string("lengths/") + length);
    for (const char* end : {"start", "finish"}) {
      const auto* laser = at(part, std::string("ends/") + end).find("tube_laser");
      if (laser == nullptr) continue;
      for (const char* gap : {"gap", "bevelled_gap"})
        if (laser->find(gap) != nullptr)
          out[member.id + " " + end + " " + gap] =
              number(*laser, std::string(gap) + "/greatest_mm");
    }
  }
  return out;
}

TEST(StepFrames, NoFigureDependsOnTheOwnFrames) {
  constexpr double kSame = 1e-3;  // mm; rows lie elsewhere, and the torch keeps off each of them
  constexpr double kSameTorch = 0.05;
  for (const auto& model : {gate(), truss(), laser_brace(), sawhorse()}) {
    const auto drawn = figures(model);
    for (const auto& other : {with_ups_reversed(model), mirrored(model)})
      for (const auto& [name, value] : figures(other))
        EXPECT_NEAR(value, drawn.at(name), name.ends_with("blank_mm") ? kSameTorch : kSame)
            << model.name << ": " << name;
  }
}

/// A leg's flush bevel closes on both edges, the step's two rows included.
TEST(StepFrames, AFlushBevelLeavesNoGapAtAStep) {
  for (const auto& [name, value] : figures(sawhorse()))
    if (name.ends_with(" bevelled_gap")) {
      EXPECT_NEAR(value, 0.0, 1e-6) << name;
    }
}

/// The kerf ends half its width beyond the torch's axis, which stays within half a kerf of the
/// finished tip: a blank is longer by both kerfs, of beams that lean by up to 80 deg.
TEST(StepFrames, ABlankIsLongerByBothKerfsAlone) {
  for (const auto& model : {truss(), laser_brace(), sawhorse()}) {
    const auto answer = made(model);
    for (const auto& member : model.members) {
      const auto& part = part_of(answer, member.id);
      const double more = number(part, "lengths/blank_mm") - number(part, "lengths/long_mm");
      EXPECT_GT(more, 0.0) << model.name << member.id;
      EXPECT_LE(more, 2.0 / std::cos(80.0 * kRadPerDeg)) << model.name << member.id;
    }
  }
}

/// Rounding moves the side of a brace past the generator by a hair, and two events lie a hair
/// apart.
TEST(StepFrames, ASliverBetweenTwoEventsIsNoOpenRoot) {
  for (const double degrees : {0.0, 37.0, 109.45, 251.0}) {
    const auto answer = made(turned(truss(), degrees));
    for (const auto& warning : *at(answer.body, "warnings").as<Json::Array>())
      EXPECT_NE(text(warning, "code"), "root_opens") << degrees << text(warning, "detail");
  }
}

}  // namespace tubecut::testing::step_frames
