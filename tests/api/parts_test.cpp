#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

constexpr const char* kPath = "/v1/parts";

Json table_1() { return example("parts/table-1-with-a-square-far-end.json"); }
Json brace() { return example("parts/k-joint-brace.json"); }
Json chord() { return example("parts/chord-with-holes.json"); }

const Json::Array& list(const Json& json, std::string_view path) {
  return *at(json, path).as<Json::Array>();
}

TEST(Parts, EveryExampleRuns) {
  for (const auto& request : {table_1(), brace(), chord()}) {
    const auto answer = post(kPath, request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
    EXPECT_EQ(text(answer.body, "verdict/status"), "ok");
    EXPECT_EQ(at(answer.body, "verification/passed"), Json{true});
    const auto count = list(answer.body, "result/check_dimensions").size();
    EXPECT_GE(count, 8u);
    EXPECT_LE(count, 12u);
    const auto& steps = list(answer.body, "result/sequence");
    EXPECT_EQ(text(steps.back(), "what"), "start");
    EXPECT_EQ(text(steps[steps.size() - 2], "what"), "finish");
  }
}

// The start's own frame is turned by nothing: its table is the bevel table, moved along z.
TEST(Parts, StartOfTable1IsItsBevelTable) {
  auto request = example("bevel-tables/source-000-table-1.json");
  request = with(request, "kerf_mm", 1.5);
  const auto table = post("/v1/bevel-tables", request);
  const auto part = post(kPath, table_1());
  ASSERT_FALSE(table.outcome.error);
  const double z0 = number(part.body, "result/frame/origin_mm/2");
  for (const char* column : {"phi_deg", "b_deg", "length_mm", "beam_mm", "dihedral_deg"})
    EXPECT_EQ(numbers(table.body, std::string("result/points/") + column),
              numbers(part.body, std::string("result/ends/start/points/") + column))
        << column;
  for (const char* column : {"z_inner_mm", "z_outer_mm", "torch_inner_mm", "torch_outer_mm"}) {
    const auto own = numbers(table.body, std::string("result/points/") + column);
    const auto placed = numbers(part.body, std::string("result/ends/start/points/") + column);
    for (std::size_t i = 0; i < own.size(); ++i) ASSERT_NEAR(placed[i], own[i] - z0, 1e-10);
  }
  EXPECT_NEAR(number(part.body, "result/lengths/work_point_mm"), 400.0, 0.0);
  EXPECT_NEAR(number(part.body, "result/lengths/long_mm"), 400.0 - z0, 1e-9);
}

Json contour_of(const Json& part, const std::string& end, double diameter, double wall) {
  const auto from = "result/ends/" + end + "/";
  return Json{Json::Object{{"points", at(part, from + "points")},
                           {"b_sign", at(part, from + "b_sign")},
                           {"scrap", at(part, from + "scrap")},
                           {"surface", at(part, from + "surface")},
                           {"outer_diameter_mm", Json{diameter}},
                           {"wall_mm", Json{wall}},
                           {"closed", Json{true}}}};
}

// Both ends go unchanged into a schedule as contours; the lead lies in what falls away, at the
// finish on the side of +z.
TEST(Parts, EndsAreContoursOfSchedules) {
  const auto part = post(kPath, brace());
  ASSERT_FALSE(part.outcome.error);
  for (const std::string end : {"start", "finish"}) {
    const Json motion = *api::parse(
        R"({"speed": {"mm_min": 600}, "start_phi_deg": "auto", "lead": {"radius_mm": 5}})");
    const Json job{Json::Object{{"contour", contour_of(part.body, end, 114.3, 5)},
                                {"machine", Json{"five_axis_cutter"}},
                                {"motion", motion}}};
    const auto schedule = post("/v1/pulse-schedules", job);
    ASSERT_FALSE(schedule.outcome.error) << end << schedule.outcome.body.substr(0, 1500);
    bool checked = false;
    for (const auto& check : list(schedule.body, "verification/checks"))
      if (text(check, "name") == "lead_clears_part") {
        checked = true;
        EXPECT_LE(number(check, "value"), number(check, "limit")) << end;
      }
    EXPECT_TRUE(checked) << end;
    // On the other side the lead would lie in the part.
    const auto wrong =
        post("/v1/pulse-schedules", with(job, "contour/scrap", Json{end == "start" ? "+z" : "-z"}));
    const double good = number(schedule.body, "result/report/time_s");
    EXPECT_GT(good, 0.0);
    if (!wrong.outcome.error) {
      EXPECT_NE(numbers(wrong.body, "result/counts/Y"), numbers(schedule.body, "result/counts/Y"));
    }
  }
}

// The finish seen from the part: its root, placed in the finish's own frame, is the bevel table
// that the node gives for that end.
TEST(Parts, FinishIsTheNodesOwnTableTurnedRound) {
  const auto request = with(brace(), "sampling", *api::parse(R"({"uniform_points": 180})"));
  const auto part = post(kPath, request);
  ASSERT_FALSE(part.outcome.error) << part.outcome.body.substr(0, 800);
  Json node{Json::Object{{"members", at(request, "members")},
                         {"connect", at(request, "connect")},
                         {"member", Json{"B2"}},
                         {"end", Json{"finish"}}}};
  node = with(node, "members/3/up", at(request, "up"));
  Json table{Json::Object{{"node", node}}};
  for (const char* name : {"root_surface", "groove", "kerf_mm", "sampling", "smoothing"})
    table = with(table, name, at(request, name));
  const auto own = post("/v1/bevel-tables", table);
  ASSERT_FALSE(own.outcome.error) << own.outcome.body.substr(0, 800);
  const auto z = numbers(own.body, "result/points/z_outer_mm");
  const auto b = numbers(own.body, "result/points/b_deg");
  const auto placed = numbers(part.body, "result/ends/finish/points/z_outer_mm");
  const auto b_placed = numbers(part.body, "result/ends/finish/points/b_deg");
  const double whole = number(part.body, "result/lengths/work_point_mm");
  // The start's work point lies on the frame's axis below its origin.
  double z0 = 0.0;
  const Json::Array& origin = list(part.body, "result/frame/origin_mm");
  const double start[] = {40, -8, 0};
  for (std::size_t k = 0; k < 3; ++k) z0 += std::pow(*origin[k].as<double>() - start[k], 2);
  z0 = std::sqrt(z0);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto j = (z.size() - i) % z.size();
    ASSERT_NEAR(placed[j], whole - z0 - z[i], 1e-9) << i;
    ASSERT_NEAR(b_placed[j], -b[i], 1e-9) << i;
  }
}

// A hole of the part is the hole of /v1/holes, moved along z.
TEST(Parts, HolesAreThoseOfTheirOwnEndpoint) {
  const auto part = post(kPath, chord());
  ASSERT_FALSE(part.outcome.error);
  const Json asked = *api::parse(R"({
    "chord": {"outer_diameter_mm": 219.1, "wall_mm": 10},
    "branch": {"size": "CHS 88.9x5", "axis": {"point_mm": [0, 0, 400], "direction": [600, 0, -500]}},
    "joint": {"kind": "set_on", "gap_mm": 2}, "groove": {"rule": "half_dihedral"}, "kerf_mm": 1.5,
    "sampling": {"tolerance_mm": 0.1}})");
  const auto hole = post("/v1/holes", asked);
  ASSERT_FALSE(hole.outcome.error) << hole.outcome.body.substr(0, 500);
  for (const char* column : {"phi_deg", "z_mm", "torch_z_mm", "torch_phi_deg", "b_deg"}) {
    const auto own = numbers(hole.body, std::string("result/holes/0/points/") + column);
    const auto placed = numbers(part.body, std::string("result/holes/0/points/") + column);
    ASSERT_EQ(own.size(), placed.size());
    for (std::size_t i = 0; i < own.size(); ++i) ASSERT_NEAR(own[i], placed[i], 1e-9) << column;
  }
  EXPECT_EQ(text(part.body, "result/holes/0/branch"), "B1");
  EXPECT_EQ(text(part.body, "result/holes/1/branch"), "B2");
  // Partners are marked where their axes leave the surface: B1 at 109.55 / 600 * 500 from 400.
  const auto& marks = list(part.body, "result/marks");
  const auto b1 =
      std::ranges::find_if(marks, [](const Json& m) { return text(m, "text") == "B1"; });
  ASSERT_NE(b1, marks.end());
  EXPECT_NEAR(number(*b1, "z_from_mm"), 400 - 109.55 * 500 / 600, 1e-9);
  EXPECT_NEAR(number(*b1, "girth_mm"), 0.0, 1e-9);
}

TEST(Parts, EchoedRequestGivesTheSameAnswer) {
  for (const auto& request : {table_1(), brace(), chord()}) {
    const auto first = post(kPath, request);
    ASSERT_FALSE(first.outcome.error);
    EXPECT_EQ(first.outcome.body, post(kPath, at(first.body, "request")).outcome.body);
  }
}

TEST(Parts, Csv) {
  const auto csv = post(kPath, api::dump(table_1()), "format=csv");
  EXPECT_TRUE(csv.outcome.body.starts_with("cut,phi_deg,z_outer_mm,"));
  EXPECT_LT(csv.outcome.body.find("finish,"), csv.outcome.body.find("\nstart,"));
  EXPECT_NE(csv.outcome.body.find("start_overhang"), std::string::npos);
}

TEST(Parts, AllowancesAndDensity) {
  auto request = with(table_1(), "allowances/facing_mm", 7.0);
  request = with(request, "density_kg_m3", 2700.0);
  const auto one = post(kPath, table_1());
  const auto two = post(kPath, request);
  EXPECT_EQ(number(one.body, "request/density_kg_m3"), 7850.0);  // the default is told
  EXPECT_NEAR(number(two.body, "result/lengths/blank_mm"),
              number(one.body, "result/lengths/blank_mm") + 7.0, 1e-9);
  EXPECT_NEAR(number(two.body, "result/lengths/mass_kg") / 2700,
              number(one.body, "result/lengths/mass_kg") / 7850, 1e-12);
}

std::string refusal(const Json& request, std::string_view pointer) {
  const auto answer = post(kPath, request);
  if (!answer.outcome.error) return "no error";
  for (const auto& one : list(answer.body, "errors"))
    if (text(one, "pointer") == pointer) return text(one, "code");
  return answer.outcome.body;
}

TEST(Parts, EveryFieldIsChecked) {
  const auto t = table_1();
  EXPECT_EQ(refusal(without(t, "target/length_mm"), "/target/length_mm"), "missing_field");
  EXPECT_EQ(refusal(with(t, "ends/finish/cutters", Json{Json::Array{}}), "/ends/finish/cutters"),
            "exclusive_fields");
  EXPECT_EQ(refusal(with(t, "members", Json{Json::Array{}}), "/members"), "exclusive_fields");
  EXPECT_EQ(refusal(with(t, "seam_deg", 10.0), "/seam_deg"), "unsupported_combination");
  EXPECT_EQ(refusal(with(t, "density_kg_m3", 7.85), "/density_kg_m3"), "out_of_range");
  EXPECT_EQ(refusal(without(t, "kerf_mm"), "/kerf_mm"), "missing_field");
  EXPECT_EQ(refusal(with(t, "ends/start/dihedral", "inside"), "/ends/start/dihedral"),
            "unknown_field");
  const auto b = brace();
  EXPECT_EQ(refusal(with(b, "member", "B3"), "/member"), "bad_choice");
  EXPECT_EQ(refusal(without(b, "up"), "/datum"), "unsupported_combination");
}

TEST(Parts, WhatCannotBeCutNamesTheField) {
  const auto t = table_1();
  EXPECT_EQ(refusal(with(t, "target/length_mm", 80.0), "/target/length_mm"), "member_consumed");
  EXPECT_EQ(refusal(with(t, "ends/start/cutters/1/inclination_deg", 1e-6),
                    "/ends/start/cutters/1/inclination_deg"),
            "parallel_axes");
  EXPECT_EQ(refusal(with(t, "torch", *api::parse(R"({"max_deg": 20})")), "/torch/max_deg"),
            "torch_range");
  const auto b = brace();
  EXPECT_EQ(refusal(with(b, "up", *api::parse("[1060, 0, 1200]")), "/up"),
            "bad_reference_direction");
  auto holes = chord();
  holes =
      with(holes, "connect", *api::parse(R"([{"member": "B1", "end": "start", "to": ["C1"]}])"));
  EXPECT_EQ(refusal(holes, "/holes/1/member"), "no_contact");
  EXPECT_EQ(refusal(with(chord(), "torch", *api::parse(R"({"max_deg": 1})")), "/torch/max_deg"),
            "torch_range");
}

}  // namespace
}  // namespace tubecut::testing
