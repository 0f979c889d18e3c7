#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

constexpr const char* kTables = "/v1/bevel-tables";
constexpr const char* kParts = "/v1/parts";

Json branch() { return example("bevel-tables/tube-laser-branch.json"); }
Json chord() { return example("parts/tube-laser-chord.json"); }
Json json(const char* text) { return *api::parse(text); }
Json parsed(const std::string& text) { return *api::parse(text); }

TEST(TubeLaser, TheEchoStatesEveryChoiceAndIsTheSameJob) {
  for (const auto& [path, body] : {std::pair{kTables, branch()}, {kParts, chord()}}) {
    const auto first = post(path, body);
    ASSERT_FALSE(first.outcome.error) << first.outcome.body.substr(0, 1500);
    const auto again = post(path, at(first.body, "request"));
    EXPECT_EQ(text(first.body, "job/input_sha256"), text(again.body, "job/input_sha256"));
    EXPECT_EQ(text(first.body, "job/result_sha256"), text(again.body, "job/result_sha256"));
    EXPECT_EQ(text(first.body, "request/preset"), "tube_laser");
  }
  const auto table = post(kTables, branch());
  EXPECT_EQ(text(table.body, "request/groove/rule"), "square");
  EXPECT_EQ(text(table.body, "request/contact"), "auto");
  EXPECT_EQ(text(table.body, "request/root_surface"), "inner");
  EXPECT_EQ(text(table.body, "request/smoothing/method"), "none");
  const auto part = post(kParts, chord());
  EXPECT_EQ(text(part.body, "request/holes/0/tilt"), "none");
  EXPECT_EQ(text(part.body, "request/holes/1/groove/rule"), "square");
  EXPECT_EQ(text(part.body, "request/ends/finish/groove/rule"), "square");
}

// Written in full and without the preset, the same cut results; only the preset's measurements are
// missing.
TEST(TubeLaser, IsTheCutThatItsFieldsSpellOut) {
  const auto preset = post(kTables, branch());
  auto body = without(without(at(preset.body, "request"), "preset"), "accept");
  const auto plain = post(kTables, body);
  ASSERT_FALSE(plain.outcome.error) << plain.outcome.body.substr(0, 800);
  for (const char* column : {"phi_deg", "z_inner_mm", "z_outer_mm", "b_deg", "torch_outer_mm"})
    EXPECT_EQ(numbers(preset.body, std::string("result/points/") + column),
              numbers(plain.body, std::string("result/points/") + column));
  EXPECT_EQ(plain.outcome.body.find("gap_outer_mm"), std::string::npos);
  EXPECT_EQ(plain.outcome.body.find("tube_laser"), std::string::npos);
}

TEST(TubeLaser, EveryCutOfAPartIsSquare) {
  const auto part = post(kParts, chord());
  for (const char* end : {"start", "finish"})
    for (const double b : numbers(part.body, std::string("result/ends/") + end + "/points/b_deg"))
      EXPECT_EQ(b, 0.0);
  const auto& holes = *at(part.body, "result/holes").as<Json::Array>();
  ASSERT_EQ(holes.size(), 3u);
  for (const auto& hole : holes)
    for (const char* angle : {"points/b_deg", "points/a_deg"})
      for (const double one : numbers(hole, angle)) EXPECT_EQ(one, 0.0);
}

TEST(TubeLaser, AContradictionIsRefusedAtItsField) {
  struct Case {
    const char* path;
    const char* field;
    const char* value;
    const char* pointer;
  };
  const std::array cases{
      Case{kTables, "groove", R"({"rule": "half_dihedral", "cap_deg": 45})", "/groove/rule"},
      Case{kTables, "contact", R"("inner")", "/contact"},
      Case{kTables, "root_face_mm", "1", "/root_face_mm"},
      Case{kTables, "smoothing", R"({"method": "hermite", "transition_points": 15})",
           "/smoothing/method"},
      Case{kTables, "torch", R"({"min_deg": 10, "max_deg": 80})", "/torch/min_deg"},
      Case{kTables, "torch", R"({"min_deg": -80, "max_deg": -5})", "/torch/max_deg"},
      Case{kTables, "preset", R"("plasma")", "/preset"},
      Case{kTables, "root_surface", R"("outer")", "/contact"},
      Case{kParts, "holes/0/tilt", R"("free")", "/holes/0/tilt"},
      Case{kParts, "holes/1/groove", R"({"rule": "none"})", "/holes/1/groove/rule"},
      Case{kParts, "ends/finish/groove", R"({"rule": "fixed", "angle_deg": 30})",
           "/ends/finish/groove/rule"},
      Case{kParts, "torch", R"({"min_deg": 5})", "/torch/min_deg"}};
  for (const auto& [path, field, value, pointer] : cases) {
    const auto body = with(path == kTables ? branch() : chord(), field, json(value));
    const auto answer = post(path, body);
    ASSERT_TRUE(answer.outcome.error) << field;
    EXPECT_EQ(at(answer.body, "errors").as<Json::Array>()->size(), 1u) << answer.outcome.body;
    EXPECT_EQ(text(answer.body, "errors/0/pointer"), pointer);
  }
  // Another contact is the caller's choice.
  for (const char* contact : {R"("none")", R"("auto")"})
    EXPECT_FALSE(post(kTables, with(branch(), "contact", json(contact))).outcome.error);
  const auto profile = with(with(branch(), "root_surface", Json{"outer"}), "contact", Json{"none"});
  EXPECT_FALSE(post(kTables, profile).outcome.error);
}

double measured(const Json& answer, std::string_view name) {
  const std::string end = "result/ends/finish/tube_laser/";
  if (name == "max_gap_mm") return number(answer, end + "gap/greatest_mm");
  if (name == "min_tongue_mm") return number(answer, end + "tongue/width_mm");
  const auto path = [&]() -> std::string {
    if (name == "min_web_mm") return "web/width_mm";
    if (name == "min_hole_to_end_mm") return "hole_to_end/width_mm";
    return "seam_to_hole/girth_mm";
  }();
  return number(answer, "result/tube_laser/" + path);
}

// Each limit passes at the measured value and fails a thousandth beyond it.
TEST(TubeLaser, EveryLimitHoldsAndFails) {
  const auto body = without(chord(), "accept");
  const auto plain = post(kParts, body);
  ASSERT_FALSE(plain.outcome.error);
  for (const std::string name :
       {"max_gap_mm", "min_tongue_mm", "min_web_mm", "min_hole_to_end_mm", "min_seam_to_hole_mm"}) {
    const double value = measured(plain.body, name);
    ASSERT_GT(value, 0.0) << name;
    const double beyond = name.starts_with("min_") ? 1e-3 : -1e-3;
    const auto held = post(kParts, with(body, "accept/" + name, Json{value}));
    EXPECT_EQ(text(held.body, "verdict/status"), "ok") << name;
    const auto failed = post(kParts, with(body, "accept/" + name, Json{value + beyond}));
    EXPECT_EQ(text(failed.body, "verdict/status"), "reject") << name;
    const auto reason = text(failed.body, "verdict/reasons/0");
    EXPECT_TRUE(reason.starts_with(name + ": ")) << reason;
    EXPECT_NE(reason.find(name.starts_with("min_") ? " < " : " > "), std::string::npos) << reason;
  }
}

// The head's way along the tube in its longest cut: here that of a hole, by its own column.
TEST(TubeLaser, ReachIsTheLongestCutOfThePart) {
  const auto body = without(chord(), "accept");
  const auto part = post(kParts, body);
  double longest = number(part.body, "result/ends/finish/tube_laser/reach_mm");
  for (const auto& hole : *at(part.body, "result/holes").as<Json::Array>()) {
    const auto z = numbers(hole, "points/torch_z_mm");
    longest = std::max(longest, std::ranges::max(z) - std::ranges::min(z));
  }
  const auto status = [&](double limit) {
    const auto answer = post(kParts, with(body, "accept/max_reach_mm", Json{limit}));
    return text(answer.body, "verdict/status");
  };
  EXPECT_EQ(status(longest + 1e-6), "ok");
  EXPECT_EQ(status(longest - 1e-3), "reject");
}

// Two posts side by side leave a few millimetres of wall between their saddles.
TEST(TubeLaser, ASliverBetweenTwoCutsIsSeen) {
  const auto body = json(R"({"preset": "tube_laser",
    "target": {"outer_diameter_mm": 200, "wall_mm": 4}, "kerf_mm": 0.2,
    "cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0, 1]},
                {"kind": "tube", "outer_diameter_mm": 120, "inclination_deg": 90,
                 "clocking_deg": 90, "offset_mm": 58},
                {"kind": "tube", "outer_diameter_mm": 120, "inclination_deg": 90,
                 "clocking_deg": 90, "offset_mm": -64}],
    "sampling": {"tolerance_mm": 0.01}})");
  const auto answer = post(kTables, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
  const double width = number(answer.body, "result/tube_laser/tongue/width_mm");
  EXPECT_GT(width, 2.0);
  EXPECT_LT(width, 20.0);
  const auto judged = post(kTables, with(body, "accept/min_tongue_mm", Json{20.0}));
  EXPECT_EQ(text(judged.body, "verdict/status"), "reject");
}

TEST(TubeLaser, ALimitWithoutAMeasurementIsRefused) {
  const auto table = json(R"({"target": {"outer_diameter_mm": 60, "wall_mm": 4},
    "cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0.5, 1]}],
    "root_surface": "inner", "groove": {"rule": "none"}, "kerf_mm": 1,
    "smoothing": {"method": "none"}})");
  ASSERT_FALSE(post(kTables, table).outcome.error);
  for (const char* name : {"max_gap_mm", "max_reach_mm", "min_tongue_mm"}) {
    const auto answer = post(kTables, with(table, std::string("accept/") + name, Json{1.0}));
    ASSERT_TRUE(answer.outcome.error) << name;
    EXPECT_EQ(text(answer.body, "errors/0/pointer"), std::string("/accept/") + name);
    EXPECT_EQ(text(answer.body, "errors/0/code"), "unsupported_combination");
  }
  const auto unseen = with(without(chord(), "seam_deg"), "datum", Json{"up"});
  const auto answer = post(kParts, unseen);
  ASSERT_TRUE(answer.outcome.error);
  EXPECT_EQ(text(answer.body, "errors/0/pointer"), "/accept/min_seam_to_hole_mm");
}

TEST(TubeLaser, AHoleAcrossTheSeamIsRejected) {
  // The stub is at phi 0 of the start: the seam goes there.
  const auto answer = post(kParts, with(chord(), "seam_deg", Json{0.0}));
  ASSERT_FALSE(answer.outcome.error);
  EXPECT_EQ(number(answer.body, "result/tube_laser/seam_to_hole/girth_mm"), 0.0);
  EXPECT_EQ(text(answer.body, "verdict/status"), "reject");
}

/// An end cut by an equal tube has two corners. Wherever they lie, also right before the first row,
/// the part has a program and pulses.
TEST(TubeLaser, ACornerNextToTheFirstRowClosesTheCut) {
  const auto part = [](double clocking) {
    return parsed(R"({"preset": "tube_laser", "kerf_mm": 0.2,
        "target": {"outer_diameter_mm": 42.4, "wall_mm": 2.6, "length_mm": 500},
        "ends": {"start": {"square_at_mm": 0}, "finish": {"cutters": [{"kind": "tube",
          "outer_diameter_mm": 42.4, "inclination_deg": 57, "clocking_deg": )" +
                  std::to_string(clocking) + "}]}}}");
  };
  for (const double clocking : {0.0, 1e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, -1e-5, -5e-5, 90.00001}) {
    const auto body = part(clocking);
    const auto text = api::dump(body);
    const auto program =
        post(kParts, std::string_view(text), "format=gcode&speed_mm_min=1200&lead_mm=2");
    EXPECT_FALSE(program.outcome.error) << clocking << program.outcome.body.substr(0, 400);
    auto job = json(R"({"machine": "generic", "motion": {"speed": {"mm_min": 1200},
                        "lead": {"radius_mm": 2}, "pierce_delay_s": 0.2}})");
    const auto pulses = post("/v1/pulse-schedules", with(job, "part", body));
    EXPECT_FALSE(pulses.outcome.error) << clocking << pulses.outcome.body.substr(0, 400);
  }
}

TEST(TubeLaser, FilesCarryTheGapsAndTheVerdict) {
  const auto csv = post(kTables, std::string_view(api::dump(branch())), "format=csv");
  EXPECT_NE(csv.outcome.body.find("gap_inner_mm,gap_outer_mm,bevelled_gap_inner_mm"),
            std::string::npos);
  const auto thin = with(chord(), "accept/min_web_mm", Json{500.0});
  const auto dry = post(kParts, std::string_view(api::dump(thin)), "format=gcode&speed_mm_min=600");
  EXPECT_NE(dry.outcome.body.find("web at least: "), std::string::npos);
  EXPECT_EQ(dry.outcome.body.find(" < "), std::string::npos);
  EXPECT_NE(dry.outcome.body.find(" below 500"), std::string::npos);
  const auto lit = post(kParts, std::string_view(api::dump(thin)),
                        "format=gcode&speed_mm_min=600&torch=on&dialect=qtplasmac&lead_mm=1");
  ASSERT_TRUE(lit.outcome.error);
  EXPECT_EQ(text(lit.body, "errors/0/pointer"), "/accept/min_web_mm");
}

}  // namespace
}  // namespace tubecut::testing
