// Pulse schedules, replays and programs of targets that are not round.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr const char* kSchedules = "/v1/pulse-schedules";
constexpr double kDeg = 0.017453292519943295;

api::Json object() { return api::Json{api::Json::Object{}}; }

api::Json laser_job() { return example("pulse-schedules/square-tube-on-a-tube-table.json"); }

/// A table that swings its torch about a pivot.
api::Json swinging_table() {
  const auto parsed = api::parse(R"({
    "type": "tube_table", "name": "swinging", "period_us": 4000, "pivot_length_mm": 120,
    "standoff_mm": 2, "b_positive": "outer_edge_to_waste", "axes": [
      {"name": "A", "unit": "deg", "pulses_per_turn": 36000, "v_max": 90, "a_max": 400, "j_max": 4000},
      {"name": "X", "unit": "mm", "pulses_per_unit": 200, "v_max": 150, "a_max": 800, "j_max": 8000},
      {"name": "Y", "unit": "mm", "pulses_per_unit": 200, "v_max": 150, "a_max": 800, "j_max": 8000},
      {"name": "Z", "unit": "mm", "pulses_per_unit": 200, "v_max": 100, "a_max": 800, "j_max": 8000},
      {"name": "B", "unit": "deg", "pulses_per_unit": 1000, "v_max": 45, "a_max": 300, "j_max": 3000}
    ]})");
  return *parsed;
}

api::Json bevelled_job() {
  auto out = with(object(), "cut", example("bevel-tables/shs-brace-on-shs-chord.json"));
  out = with(out, "machine", swinging_table());
  return with(out, "motion/speed/mm_min", 900.0);
}

Posted answered(const char* path, const api::Json& request) {
  auto answer = post(path, request);
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  return answer;
}

std::vector<double> sums(const Posted& answer, const std::string& axis, double per_unit) {
  std::vector<double> out{number(answer.body, "result/start/" + axis)};
  for (const double n : numbers(answer.body, "result/counts/" + axis))
    out.push_back(out.back() + n / per_unit);
  return out;
}

TEST(SectionSchedules, TubeLaserEndIsVerified) {
  const auto answer = answered(kSchedules, laser_job());
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  EXPECT_EQ(number(answer.body, "request/motion/lean_deg"), 1.0);
  EXPECT_EQ(text(answer.body, "request/motion/speed_on"), "outer");
  const double lean = number(answer.body, "result/report/lean_deg");
  EXPECT_GT(lean, 0.5);
  EXPECT_LT(lean, 1.5);
  std::vector<std::string> checks;
  for (const auto& check : *at(answer.body, "verification/checks").as<api::Json::Array>())
    checks.push_back(text(check, "name"));
  for (const char* name : {"on_section", "I1", "I2", "I4", "I5", "I6", "I7", "I10", "I11", "I12",
                           "I13", "I14", "I15", "I16", "lead_clears_part"})
    EXPECT_NE(std::ranges::find(checks, name), checks.end()) << name;
}

/// Undoes the turn by the counts alone: the tip stays within 0.05 mm of the square's outside, at
/// the stated stand-off, and reaches every corner.
TEST(SectionSchedules, CountsKeepTheStandoffAroundTheCorners) {
  const auto answer = answered(kSchedules, laser_job());
  const auto turn = sums(answer, "A", 1000.0), x = sums(answer, "X", 1000.0),
             z = sums(answer, "Z", 1000.0);
  ASSERT_GT(turn.size(), 1000U);
  double farthest = 0.0, corner = 0.0;
  for (std::size_t i = 0; i < turn.size(); ++i) {
    const double up = -turn[i] * kDeg, height = z[i] - 1.0;  // the built-in table's standoff
    const double px = std::abs(height * std::cos(up) - x[i] * std::sin(up));
    const double py = std::abs(height * std::sin(up) + x[i] * std::cos(up));
    const double dx = std::max(0.0, px - 40.0), dy = std::max(0.0, py - 40.0);
    farthest = std::max(farthest, std::abs(std::hypot(dx, dy) - 10.0));
    corner = std::max(corner, std::min(px, py));
  }
  EXPECT_LE(farthest, 0.05);
  EXPECT_GT(corner, 47.0);
}

TEST(SectionSchedules, BevelledEndIsVerifiedAndReplayed) {
  auto job = bevelled_job();
  const auto answer = answered(kSchedules, job);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  EXPECT_EQ(number(answer.body, "request/motion/start_girth_mm"), 0.0);
  const auto replay = answered("/v1/replays", with(job, "schedule", at(answer.body, "result")));
  for (const auto& invariant : *at(replay.body, "result/invariants").as<api::Json::Array>())
    EXPECT_EQ(at(invariant, "passed"), api::Json{true}) << text(invariant, "name");
  const auto x = numbers(replay.body, "result/path/x_mm"),
             y = numbers(replay.body, "result/path/y_mm"),
             nu = numbers(replay.body, "result/path/normal_deg"),
             b = numbers(replay.body, "result/path/b_deg");
  ASSERT_EQ(x.size(), static_cast<std::size_t>(number(answer.body, "result/periods")) + 1);
  EXPECT_NEAR(nu.back() - nu.front(), 360.0, 1e-9);
  // B of the table's faces 1 and 3, in the table's sign although the machine counts it in reverse.
  const auto table = answered("/v1/bevel-tables", at(job, "cut"));
  const auto rows = numbers(table.body, "result/points/b_deg");
  EXPECT_NEAR(std::ranges::max(b), std::ranges::max(rows), 0.6);
  EXPECT_NEAR(std::ranges::min(b), std::ranges::min(rows), 0.6);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_LE(std::max(std::abs(x[i]), std::abs(y[i])), 40.06);
  }
}

TEST(SectionSchedules, EndOfANodeIsCut) {
  const auto node = example("nodes/rhs-t-joint.json");
  auto cut = with(object(), "node/members", at(node, "members"));
  cut = with(cut, "node/connect", at(node, "connect"));
  cut = with(cut, "node/member", api::Json{std::string("post")});
  cut = with(cut, "node/end", api::Json{std::string("start")});
  cut = with(with(cut, "preset", api::Json{std::string("tube_laser")}), "kerf_mm", 0.2);
  auto job = with(with(laser_job(), "cut", cut), "motion/lead", api::Json{});
  const auto answer = answered(kSchedules, job);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
}

/// A sector by girth is cut again over two corners; backwards the turn counts on the other way.
TEST(SectionSchedules, SectorsAndDirectionsAreByGirth) {
  auto job = with(laser_job(), "motion/lead", api::Json{});
  job = with(job, "motion/start_girth_mm", 10.0);
  const auto back =
      answered(kSchedules, with(job, "motion/direction", api::Json{std::string("cw")}));
  EXPECT_EQ(number(back.body, "result/total/A"), 360000.0);
  auto part = with(job, "motion/sector/from_girth_mm", 20.0);
  part = with(part, "motion/sector/to_girth_mm", 170.0);
  const auto answer = answered(kSchedules, part);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  EXPECT_NEAR(number(answer.body, "result/total/A"), -180000.0, 1.0);
  part = with(part, "motion/sector/from_phi_deg", 0.0);
  EXPECT_NE(error_at(post(kSchedules, part), "/motion/sector/from_phi_deg"), nullptr);
}

/// Each problem at its own field, all in one answer.
TEST(SectionSchedules, MachineWithoutAnAxisAcrossIsRefused) {
  for (const char* machine : {"five_axis_cutter", "crawler", "generic", "cone_mill"}) {
    auto job = with(laser_job(), "machine", api::Json{std::string(machine)});
    job = with(job, "motion/start_phi_deg", 0.0);
    job = with(job, "motion/speed_on", api::Json{std::string("inner")});
    job = with(job, "motion/lean_deg", 9.0);
    const auto answer = post(kSchedules, job);
    ASSERT_TRUE(answer.outcome.error) << machine;
    const auto* one = error_at(answer, "/machine");
    ASSERT_NE(one, nullptr) << answer.outcome.body.substr(0, 1500);
    EXPECT_EQ(text(*one, "code"), "unsupported_combination");
    EXPECT_NE(text(*one, "hint").find(machine), std::string::npos);
    EXPECT_NE(text(*one, "hint").find("no axis across the tube"), std::string::npos);
    for (const auto& [pointer, code] :
         {std::pair{"/motion/start_phi_deg", "unsupported_combination"},
          {"/motion/speed_on", "unsupported_combination"},
          {"/motion/lean_deg", "out_of_range"}}) {
      const auto* other = error_at(answer, pointer);
      ASSERT_NE(other, nullptr) << pointer << answer.outcome.body.substr(0, 1500);
      EXPECT_EQ(text(*other, "code"), code);
    }
  }
}

TEST(SectionSchedules, BevelWithoutASwingIsRefused) {
  const auto answer =
      post(kSchedules, with(bevelled_job(), "machine", api::Json{std::string("tube_table")}));
  ASSERT_TRUE(answer.outcome.error);
  const auto* one = error_at(answer, "/machine/axes");
  if (one == nullptr) one = error_at(answer, "/machine");
  ASSERT_NE(one, nullptr) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(text(*one, "code"), "unsupported_combination");
}

TEST(SectionSchedules, FieldsOfSectionsAreRefusedOfRoundTargets) {
  auto job = with(laser_job(), "cut/target", with(object(), "outer_diameter_mm", 100.0));
  job = with(job, "cut/target/wall_mm", 5.0);
  const auto answer = post(kSchedules, job);
  ASSERT_TRUE(answer.outcome.error);
  const auto* one = error_at(answer, "/motion/start_girth_mm");
  ASSERT_NE(one, nullptr);
  EXPECT_EQ(text(*one, "code"), "unsupported_combination");
  // If the target is not understood, it is not known which fields belong to it.
  const auto unknown = post(kSchedules, with(laser_job(), "cut/target/size", api::Json{7.0}));
  ASSERT_NE(error_at(unknown, "/cut/target/size"), nullptr);
  EXPECT_EQ(error_at(unknown, "/motion/start_girth_mm"), nullptr) << unknown.outcome.body;
}

/// A tube table cuts round tubes too: A turns, X rests.
TEST(SectionSchedules, TubeTableCutsRoundTubes) {
  auto job = with(laser_job(), "cut/target", with(object(), "outer_diameter_mm", 100.0));
  job = with(job, "cut/target/wall_mm", 5.0);
  job = without(job, "motion/start_girth_mm");
  const auto answer = answered(kSchedules, job);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  EXPECT_EQ(text(answer.body, "result/idle/0"), "X");
}

TEST(SectionSchedules, ProgramHasTheAxesOfTheTable) {
  const auto body = api::dump(laser_job());
  const auto program = post(kSchedules, std::string_view(body), "format=gcode&torch=on");
  ASSERT_FALSE(program.outcome.error) << program.outcome.body.substr(0, 800);
  const auto& lines = program.outcome.body;
  for (const char* head : {"(A = axis A, deg)", "(X = axis X, mm)", "(Y = axis Y, mm)",
                           "(Z = axis Z, mm)", "M3 S1", "M5"})
    EXPECT_NE(lines.find(head), std::string::npos) << head;
  EXPECT_NE(lines.find("\nG1 A"), std::string::npos);
  const auto chart = post(kSchedules, std::string_view(body), "format=svg");
  EXPECT_FALSE(chart.outcome.error) << chart.outcome.body.substr(0, 800);
}

/// A small opening is gone round within a few periods, and its check does not mistake its end for
/// its start.
TEST(PartSchedules, TinyOpeningsAreFollowedRound) {
  const auto job = [](double speed, double tolerance) {
    return *api::parse(R"({"part": {"target": {"outer_diameter_mm": 33.7, "wall_mm": 2,
        "length_mm": 200}, "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
        "kerf_mm": 0.2, "cutouts": [{"id": "c", "shape": {"kind": "circle", "diameter_mm": 1},
        "at": {"z_mm": 100, "phi_deg": 30}}]}, "machine": "five_axis_cutter", "motion": {"lead":
        {"radius_mm": 3}, "eps_tip_mm": )" +
                       std::to_string(tolerance) + R"(, "speed": {"mm_min": )" +
                       std::to_string(speed) + "}}}");
  };
  for (const double speed : {600.0, 3000.0, 12000.0})
    for (const double tolerance : {0.02, 0.1, 0.25}) {
      const auto answer = post(kSchedules, job(speed, tolerance));
      EXPECT_FALSE(answer.outcome.error)
          << speed << " " << tolerance << answer.outcome.body.substr(0, 300);
    }
  const auto refused = post(kSchedules, job(3000.0, 0.3));
  ASSERT_TRUE(refused.outcome.error);
  EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/motion/eps_tip_mm");
  EXPECT_NEAR(number(refused.body, "errors/0/limit"), 0.1 * M_PI * 0.8, 0.02);  // longer round
}

/// A window begins in the middle of a side; by rounding, that is no second point there.
TEST(SectionSchedules, WindowsTurnedOnAFaceAreMade) {
  for (const bool as_cut : {true, false})
    for (int face = 1; face <= 4; ++face)
      for (int turn = 0; turn <= 180; turn += 15) {
        const auto job = api::parse(
            R"({"part": {"target": {"size": "SHS 80x80x4 EN 10219", "length_mm": 400},
                "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "kerf_mm": 1,
                "cutouts": [{"id": "w", "shape": {"kind": "rectangle", "along_mm": 18, "round_mm": 6,
                "corners": ")" +
            std::string(as_cut ? "as_cut" : "rounded") + R"(", "angle_deg": )" +
            std::to_string(turn) + R"(}, "at": {"z_mm": 200, "face": )" + std::to_string(face) +
            R"(}}]}, "machine": "tube_table", "motion": {"speed": {"mm_min": 1200}, "lead": {}}})");
        ASSERT_TRUE(job);
        const auto answer = post(kSchedules, *job);
        EXPECT_FALSE(answer.outcome.error)
            << face << " " << turn << answer.outcome.body.substr(0, 300);
      }
}

}  // namespace
}  // namespace tubecut::testing
