#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr const char* kTables = "/v1/bevel-tables";
constexpr double kDeg = std::numbers::pi / 180.0;

api::Json brace() { return example("bevel-tables/shs-brace-on-shs-chord.json"); }

api::Json object() { return api::Json{api::Json::Object{}}; }

api::Json laser() {
  auto out = brace();
  for (const char* field : {"root_surface", "groove", "smoothing"}) out = without(out, field);
  return with(with(out, "preset", "tube_laser"), "kerf_mm", 0.2);
}

Posted answered(const api::Json& request) {
  auto answer = post(kTables, request);
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  return answer;
}

TEST(SectionTables, BraceOnChordIsVerified) {
  const auto answer = answered(brace());
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  EXPECT_EQ(text(answer.body, "request/target/kind"), "rectangular_tube");
  EXPECT_EQ(text(answer.body, "result/section/corners"), "nominal");
  std::vector<std::string> checks;
  for (const auto& check : *at(answer.body, "verification/checks").as<api::Json::Array>())
    checks.push_back(text(check, "name"));
  for (const char* name : {"on_section", "dihedral", "bevel_plane", "above_required", "slope",
                           "second_difference", "area_excess", "torch_range", "penetration",
                           "penetration_stated", "penetration_between", "gouge", "gouge_stated"})
    EXPECT_NE(std::ranges::find(checks, name), checks.end()) << name;
}

/// On a flat chord face, B of each face of the brace has a closed form; between two faces it passes
/// the corner without a step.
TEST(SectionTables, FacesHaveClosedFormsAndCornersJoinThem) {
  auto request = with(brace(), "smoothing", with(object(), "method", "none"));
  request = with(request, "sampling", with(object(), "tolerance_mm", 0.005));
  const auto answer = answered(request);
  const auto rows = [&](const char* name) {
    return numbers(answer.body, std::string("result/points/") + name);
  };
  const auto girth = rows("girth_mm"), face = rows("face"), b = rows("b_deg"),
             dihedral = rows("dihedral_deg"), wall = rows("wall_mm"), z_in = rows("z_inner_mm"),
             z_out = rows("z_outer_mm");
  const auto& corner = *at(answer.body, "result/points/on_corner").as<api::Json::Array>();
  // The chord's face is inclined by 45 deg towards +x. Half of the dihedral below 90 deg, else 45.
  const double dihedrals[] = {45.0, 90.0, 135.0, 90.0};
  int flats = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    EXPECT_DOUBLE_EQ(wall[i], 4.0);
    EXPECT_NEAR(z_out[i] - z_in[i], 4.0 * std::tan(b[i] * kDeg), 1e-9);
    if (corner[i] == api::Json{true}) continue;
    ++flats;
    const auto k = static_cast<std::size_t>(face[i]) - 1;
    EXPECT_NEAR(dihedral[i], dihedrals[k], 1e-9) << girth[i];
  }
  EXPECT_GT(flats, 8);
  // In a mitre of 90 deg B turns by at most 11.4 deg per mm of a bore's corner of 5 mm. Here the
  // bore's corner has 4 mm and half the length of the outside's.
  for (std::size_t i = 0; i + 1 < b.size(); ++i)
    EXPECT_LE(std::abs(b[i + 1] - b[i]), 11.4 * 5.0 / 4.0 / 2.0 * (girth[i + 1] - girth[i]) + 1e-6)
        << girth[i];
}

TEST(SectionTables, TubeLaserStatesItsGaps) {
  const auto answer = answered(with(laser(), "accept/max_gap_mm", 50.0));
  const auto b = numbers(answer.body, "result/points/b_deg");
  EXPECT_TRUE(std::ranges::all_of(b, [](double one) { return one == 0.0; }));
  const auto outer = numbers(answer.body, "result/points/gap_outer_mm"),
             inner = numbers(answer.body, "result/points/gap_inner_mm");
  const double most = std::max(std::ranges::max(outer), std::ranges::max(inner));
  EXPECT_NEAR(number(answer.body, "result/tube_laser/gap/greatest_mm"), most, 1e-12);
  // A square cut on a face at 45 deg leaves the wall times the sine of it at one edge.
  EXPECT_NEAR(most, 4.0 * std::sin(45.0 * kDeg), 1e-6);
  EXPECT_EQ(api::dump(at(answer.body, "verdict/reasons")), R"(["root_opens"])");
  const auto refused = answered(with(laser(), "accept/max_gap_mm", 0.5));
  EXPECT_EQ(text(refused.body, "verdict/status"), "reject");
}

/// Corners of half the side: the numbers of the round tube.
TEST(SectionTables, OvalOfEqualSidesIsTheRoundTube) {
  auto round = example("bevel-tables/source-000-table-1.json");
  round = with(round, "sampling", with(object(), "uniform_points", 180.0));
  round = with(round, "smoothing", with(object(), "method", "none"));  // lengths differ by rounding
  const double diameter = number(round, "target/outer_diameter_mm"),
               wall = number(round, "target/wall_mm");
  auto target = with(with(object(), "kind", "flat_oval_tube"), "wall_mm", wall);
  target = with(with(target, "height_mm", diameter), "width_mm", diameter);
  const auto a = answered(round), b = answered(with(round, "target", target));
  for (const char* name : {"z_inner_mm", "z_outer_mm", "b_raw_deg", "b_required_deg", "b_deg",
                           "dihedral_deg", "gamma_deg", "flush_deg", "gap_mm", "beam_mm"}) {
    const auto path = std::string("result/points/") + name;
    const auto one = numbers(a.body, path), other = numbers(b.body, path);
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-9) << name << i;
  }
}

TEST(SectionTables, ReversedSidesGiveTheSameCutQuarterTurned) {
  const auto rectangle = [](double height, double width) {
    auto out = with(with(object(), "kind", "rectangular_tube"), "wall_mm", 4.0);
    out = with(with(out, "height_mm", height), "width_mm", width);
    return with(out, "corners", "en_10210");
  };
  const auto chord = [](double clocking) {
    auto out = with(with(object(), "kind", "tube"), "outer_diameter_mm", 168.3);
    out = with(with(out, "inclination_deg", 60.0), "clocking_deg", clocking);
    return api::Json{api::Json::Array{out}};
  };
  auto request = with(brace(), "smoothing", with(object(), "method", "none"));
  request = with(request, "sampling", with(object(), "tolerance_mm", 0.001));
  const auto a = answered(with(with(request, "target", rectangle(100, 60)), "cutters", chord(30)));
  const auto b = answered(with(with(request, "target", rectangle(60, 100)), "cutters", chord(120)));
  for (const char* name : {"z_outer_mm", "b_deg", "torch_outer_mm"}) {
    const auto path = std::string("result/points/") + name;
    const auto one = numbers(a.body, path), other = numbers(b.body, path);
    EXPECT_NEAR(std::ranges::max(one), std::ranges::max(other), 2e-3) << name;
    EXPECT_NEAR(std::ranges::min(one), std::ranges::min(other), 2e-3) << name;
  }
  EXPECT_NEAR(number(a.body, "result/length_mm"), number(b.body, "result/length_mm"), 1e-6);
}

TEST(SectionTables, RefusesWhatOnlyRoundTargetsHave) {
  expect_refused(
      kTables,
      with(with(with(brace(), "root_surface", "outer"), "contact", "none"), "dihedral", "inside"),
      "/dihedral", "unsupported_combination");
  auto hermite = with(with(object(), "method", "hermite"), "transition_points", 5.0);
  expect_refused(kTables, with(with(brace(), "contact", "none"), "smoothing", hermite),
                 "/smoothing/method", "unsupported_combination");
  auto zone = with(with(object(), "id", "all"), "root_gap_mm", 2.0);
  zone = with(zone, "dihedral_deg", api::Json{api::Json::Array{api::Json{0.0}, api::Json{180.0}}});
  zone = with(zone, "groove_deg", api::Json{api::Json::Array{api::Json{30.0}, api::Json{30.0}}});
  auto zones = with(with(object(), "rule", "zones"), "zones", api::Json{api::Json::Array{zone}});
  expect_refused(kTables, with(brace(), "groove", zones), "/groove/zones/0/root_gap_mm",
                 "unsupported_combination");
  expect_refused(kTables, with(laser(), "accept/min_tongue_mm", 5.0), "/accept/min_tongue_mm",
                 "unsupported_combination");
  expect_refused(kTables, with(brace(), "accept/min_tongue_mm", 5.0), "/accept/min_tongue_mm",
                 "unsupported_combination");
  expect_refused(kTables,
                 with(brace(), "columns", api::Json{api::Json::Array{api::Json{"phi_deg"}}}),
                 "/columns/0", "bad_choice");
  expect_refused(kTables, with(brace(), "kerf_mm", 40.0), "/kerf_mm", "out_of_range");
  expect_refused(kTables, with(brace(), "kerf_mm", 0.001), "/kerf_mm", "out_of_range");
  expect_refused(kTables, with(brace(), "root_face_mm", 4.0), "/root_face_mm", "out_of_range");
  expect_refused(kTables, with(with(brace(), "contact", "auto"), "root_face_mm", 1.0),
                 "/root_face_mm", "unsupported_combination");
  expect_refused(kTables,
                 with(brace(), "torch", with(with(object(), "min_deg", -10.0), "max_deg", 10.0)),
                 "/torch/max_deg", "torch_range");
  expect_refused(kTables, with(laser(), "torch", with(object(), "min_deg", 5.0)), "/torch/min_deg",
                 "unsupported_combination");
  // Several at once.
  const auto both = post(kTables, with(with(brace(), "dihedral", "inside"), "smoothing", hermite));
  EXPECT_NE(error_at(both, "/dihedral"), nullptr);
  EXPECT_NE(error_at(both, "/smoothing/method"), nullptr);
}

TEST(SectionTables, ZonesWithoutRootGapsAreCut) {
  auto zone = with(object(), "id", "all");
  zone = with(zone, "dihedral_deg", api::Json{api::Json::Array{api::Json{0.0}, api::Json{180.0}}});
  zone = with(zone, "groove_deg", api::Json{api::Json::Array{api::Json{30.0}, api::Json{30.0}}});
  auto zones = with(with(object(), "rule", "zones"), "zones", api::Json{api::Json::Array{zone}});
  const auto answer = answered(with(brace(), "groove", zones));
  const auto groove = numbers(answer.body, "result/points/groove_deg");
  for (const double one : groove) EXPECT_NEAR(one, 30.0, 1e-9);
  EXPECT_EQ(at(answer.body, "result/points/zone").as<api::Json::Array>()->size(), groove.size());
}

TEST(SectionTables, CsvHasTheColumnsAndOtherFormatsNameIt) {
  const auto body = api::dump(brace());
  const auto csv = post(kTables, std::string_view(body), "format=csv");
  ASSERT_FALSE(csv.outcome.error) << csv.outcome.body.substr(0, 500);
  EXPECT_NE(csv.outcome.body.find("# b_sign: outer_edge_into_part"), std::string::npos);
  EXPECT_NE(csv.outcome.body.find("girth_mm,normal_deg,face,on_corner,wall_mm"), std::string::npos);
  for (const char* format : {"step", "nc1"}) {
    const auto other = post(kTables, std::string_view(body), std::string("format=") + format);
    ASSERT_TRUE(other.outcome.error) << format;
    EXPECT_NE(other.outcome.body.find("csv"), std::string::npos) << format;
  }
  const auto gcode = post(kTables, std::string_view(body), "format=gcode&speed_mm_min=600");
  ASSERT_TRUE(gcode.outcome.error);
  EXPECT_NE(error_at(gcode, "?pivot_length_mm"), nullptr) << gcode.outcome.body;
}

TEST(SectionTables, NamedColumnsArePrintedAndHashTheWhole) {
  const auto whole = answered(brace());
  const auto columns = api::Json{api::Json::Array{api::Json{"girth_mm"}, api::Json{"b_deg"}}};
  const auto some = answered(with(brace(), "columns", columns));
  EXPECT_EQ(at(some.body, "result/points").as<api::Json::Object>()->size(), 2U);
  EXPECT_EQ(text(some.body, "job/result_sha256"), text(whole.body, "job/result_sha256"));
}

}  // namespace
}  // namespace tubecut::testing
