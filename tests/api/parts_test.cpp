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
Json set_in() { return example("parts/set-in-branch.json"); }

const Json::Array& list(const Json& json, std::string_view path) {
  return *at(json, path).as<Json::Array>();
}

TEST(Parts, EveryExampleRuns) {
  for (const auto& request : {table_1(), brace(), chord(), set_in()}) {
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

// Both ends go unchanged into a schedule as contours; the lead lies in the scrap, at the finish on
// the side of +z.
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

// The branch of the chord's set-in hole as a separate part: its inner edge lies on the chord's bore
// (it was on the outer surface, up to 12.9 mm off). C1 runs along the world's x axis.
TEST(Parts, ASetInBranchReachesTheBoreOfItsHole) {
  const auto part = post(kPath, set_in());
  ASSERT_FALSE(part.outcome.error) << part.outcome.body.substr(0, 800);
  const auto phi = numbers(part.body, "result/ends/start/points/phi_deg");
  const auto z = numbers(part.body, "result/ends/start/points/z_inner_mm");
  const auto axis = [&](const char* name) {
    return numbers(part.body, std::string("result/frame/") + name);
  };
  const auto o = axis("origin_mm"), x = axis("x"), y = axis("y"), w = axis("z");
  ASSERT_GE(phi.size(), 36U);
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const double a = phi[i] * std::acos(-1.0) / 180, rho = 114.3 / 2 - 6.3;
    const auto at = [&](std::size_t k) {
      return o[k] + rho * (std::cos(a) * x[k] + std::sin(a) * y[k]) + z[i] * w[k];
    };
    EXPECT_NEAR(std::hypot(at(1), at(2)), 99.55, 1e-9) << phi[i];
  }
  EXPECT_EQ(number(part.body, "result/lengths/weld_mm"), 0.0);  // it is welded round its hole
}

bool warned(const Posted& answer, std::string_view code, std::string_view pointer) {
  return std::ranges::any_of(list(answer.body, "warnings"), [&](const Json& w) {
    return text(w, "code") == code && text(w, "pointer") == pointer;
  });
}

TEST(Parts, EchoedRequestGivesTheSameAnswer) {
  for (const auto& request : {table_1(), brace(), chord(), set_in()}) {
    const auto first = post(kPath, request);
    ASSERT_FALSE(first.outcome.error);
    EXPECT_EQ(first.outcome.body, post(kPath, at(first.body, "request")).outcome.body);
  }
}

TEST(Parts, Csv) {
  const auto csv = post(kPath, api::dump(table_1()), "format=csv");
  EXPECT_TRUE(csv.outcome.body.starts_with(
      "# verdict: ok\r\n# b_sign: outer_edge_to_plus_z\r\ncut,phi_deg,developed_mm,"));
  EXPECT_LT(csv.outcome.body.find("finish,"), csv.outcome.body.find("\nstart,"));
  const auto tape = post(kPath, api::dump(table_1()), "format=csv&view=check_dimensions");
  EXPECT_NE(tape.outcome.body.find("\nstart_overhang,"), std::string::npos);
}

TEST(Parts, AllowancesAndDensity) {
  auto request = with(table_1(), "allowances/facing_mm", 7.0);
  request = with(request, "density_kg_m3", 2700.0);
  const auto one = post(kPath, table_1());
  const auto two = post(kPath, request);
  EXPECT_EQ(number(one.body, "request/density_kg_m3"), 7850.0);  // the default is echoed
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

TEST(Parts, OneJointIsStatedInOneWay) {
  const auto c = chord();
  const Json same = *api::parse(R"({"kind": "set_in", "gap_mm": 1.5})");
  const Json other = *api::parse(R"({"kind": "set_in", "gap_mm": 2})");
  const auto both = [](Json json, const Json& joint) {
    auto said = with(joint, "member", "B2");
    return with(std::move(json), "members/0/joints/0", said);
  };
  EXPECT_FALSE(post(kPath, with(c, "holes/1/joint", same)).outcome.error);
  EXPECT_EQ(refusal(with(c, "holes/1/joint", other), "/holes/1/joint"), "joint_contradicts");
  const auto told = with(c, "holes/0/joint", *api::parse(R"({"kind": "set_on", "gap_mm": 2})"));
  EXPECT_FALSE(post(kPath, both(told, same)).outcome.error);
  EXPECT_EQ(refusal(both(told, other), "/members/2/joints/0"), "joint_contradicts");
  EXPECT_EQ(refusal(without(c, "members/0/joints"), "/holes/0/joint"), "missing_field");
  EXPECT_EQ(refusal(with(c, "members/0/joints/0/member", "C1"), "/members/0/joints/0/member"),
            "bad_choice");
  EXPECT_EQ(refusal(with(c, "members/0/joints/0/depth_mm", 3.0), "/members/0/joints/0/depth_mm"),
            "unsupported_combination");
  EXPECT_EQ(refusal(with(c, "members/2/joints/0/depth_mm", 200.0), "/members/2/joints/0/depth_mm"),
            "out_of_range");
  auto on = with(with(set_in(), "member", "B1"), "root_gap_mm", 1.0);
  EXPECT_EQ(refusal(on, "/root_gap_mm"), "joint_contradicts");
  // If only one of the two calls would apply it, the answer reports it.
  auto unsaid = with(without(c, "members/2/joints"), "holes/1/joint", same);
  EXPECT_TRUE(warned(post(kPath, unsaid), "joint_not_stated", "/holes/1/joint"));
  auto missing = with(c, "holes", Json{Json::Array{at(c, "holes/0")}});
  EXPECT_TRUE(warned(post(kPath, missing), "hole_missing", "/members/2"));
}

/// One end of a member of this request's node, given directly: cutter and joint as in the answer of
/// /v1/nodes.
Json direct(const Json& request, std::string_view member) {
  const auto nodes = post("/v1/nodes", Json{Json::Object{{"members", at(request, "members")},
                                                         {"connect", at(request, "connect")}}});
  Json end, chord{Json::Object{{"kind", Json{"tube"}}, {"outer_diameter_mm", Json{219.1}}}};
  for (const auto& one : list(nodes.body, "result/ends"))
    if (text(one, "member") == member && text(one, "end") == "start") end = one;
  for (const auto& [name, value] : *at(end, "cut_by/0/placement").as<Json::Object>())
    chord = with(chord, name, value);
  Json cut{Json::Object{
      {"cutters", Json{Json::Array{chord}}},
      {"joints", Json{Json::Array{with(at(end, "cut_by/0/joint"), "cutter", Json{0.0})}}}}};
  for (const auto* name : {"root_surface", "groove", "smoothing"})
    cut = with(cut, name, at(request, name));
  const Json square{Json::Object{{"square_at_mm", Json{0.0}}}};
  return Json{
      Json::Object{{"target", *api::parse(R"({"size": "CHS 114.3x6.3", "length_mm": 700})")},
                   {"ends", Json{Json::Object{{"start", cut}, {"finish", square}}}},
                   {"marks", *api::parse(R"([{"text": "P", "phi_deg": 30, "z_mm": 400}])")},
                   {"kerf_mm", at(request, "kerf_mm")},
                   {"sampling", at(request, "sampling")}}};
}

TEST(Parts, EndsSayHowTheirCuttersAreJoined) {
  const auto whole = post(kPath, set_in());
  const auto request = direct(set_in(), "B2");
  const auto part = post(kPath, request);
  ASSERT_FALSE(part.outcome.error) << part.outcome.body.substr(0, 800);
  for (const char* column : {"z_inner_mm", "z_outer_mm", "torch_outer_mm"}) {
    const auto at_end = std::string("result/ends/start/points/") + column;
    const auto a = numbers(whole.body, at_end), b = numbers(part.body, at_end);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9);
  }
  EXPECT_EQ(number(part.body, "result/ends/start/weld_mm"), 0.0) << "it is that of the hole";
  const auto& mark = list(part.body, "result/marks").back();
  EXPECT_EQ(text(mark, "kind"), "partner");
  EXPECT_NEAR(number(mark, "phi_deg"), 30.0, 1e-12);
  EXPECT_NEAR(number(mark, "z_from_mm") - 400.0, -number(part.body, "result/frame/origin_mm/2"),
              1e-9);
  const auto without_joint = post(kPath, without(request, "ends/start/joints"));
  EXPECT_GT(number(without_joint.body, "result/ends/start/weld_mm"), 300.0);
}

TEST(Parts, JointsOfAnEndAreChecked) {
  const auto request = direct(set_in(), "B2");
  const auto refused = [&](std::string_view path, Json value) {
    const auto answer = post(kPath, with(request, path, std::move(value)));
    return text(answer.body, "errors/0/code") + " " + text(answer.body, "errors/0/pointer");
  };
  EXPECT_EQ(refused("ends/start/joints/0/cutter", Json{1.0}),
            "out_of_range /ends/start/joints/0/cutter");
  EXPECT_EQ(refused("ends/start/joints/0/depth_mm", Json{109.55}),
            "out_of_range /ends/start/joints/0/depth_mm");
  EXPECT_EQ(refused("ends/start/joints/0/kind", Json{"through"}),
            "bad_choice /ends/start/joints/0/kind");
  const auto joint = at(request, "ends/start/joints/0");
  EXPECT_EQ(refused("ends/start/joints", Json{Json::Array{joint, joint}}),
            "duplicate_id /ends/start/joints/1/cutter");
  EXPECT_EQ(refused("ends/start/joints", *api::parse(R"([{"cutter": 0, "kind": "mitre"}])")),
            "unsupported_combination /ends/start/joints/0/kind");
  EXPECT_EQ(refused("marks/0/text", Json{""}), "bad_text /marks/0/text");
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

// A hole for a branch of 30 mm square to a tube cut square at 0 and 400 mm.
TEST(Parts, AHoleBeyondAnEndIsRefusedAndOneOnItReviewed) {
  const auto at_height = [](double height, const char* kind) {
    auto request = *api::parse(R"({
      "target": {"outer_diameter_mm": 100, "wall_mm": 5, "length_mm": 400},
      "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
      "holes": [{"branch": {"outer_diameter_mm": 30, "wall_mm": 3, "inclination_deg": 90},
                 "joint": {"kind": "set_on"}, "groove": {"rule": "none"}}],
      "kerf_mm": 1, "datum": "seam", "sampling": {"uniform_points": 90}})");
    request = with(request, "holes/0/joint/kind", kind);
    return post(kPath, with(request, "holes/0/branch/height_mm", height));
  };
  for (const char* kind : {"set_on", "through"})
    for (const double height : {-200.0, -16.0, 416.0, 3000.0}) {
      const auto off = at_height(height, kind);
      EXPECT_EQ(text(off.body, "code"), "hole_off_part")
          << height << off.outcome.body.substr(0, 300);
      EXPECT_EQ(text(off.body, "errors/0/pointer"), "/holes/0");
      EXPECT_NE(text(off.body, "errors/0/hint").find(height < 0 ? "start" : "finish"),
                std::string::npos);
    }
  for (const double height : {-10.0, 0.0, 10.0, 390.0, 410.0}) {
    const auto half = at_height(height, "set_on");
    EXPECT_EQ(text(half.body, "verdict/status"), "review") << height;
    EXPECT_EQ(text(half.body, "warnings/0/code"), "hole_meets_end");
  }
  EXPECT_EQ(text(at_height(200.0, "set_on").body, "verdict/status"), "ok");
}

// A wide branch along whose surface the wall's lines run together within a thick chord.
TEST(Parts, ASelfCrossingEdgeIsRefusedAtItsBranchOnly) {
  const auto refused = post(kPath, *api::parse(R"({
    "target": {"outer_diameter_mm": 180, "wall_mm": 20.7, "length_mm": 1400},
    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
    "holes": [{"branch": {"outer_diameter_mm": 134.2, "wall_mm": 20.7, "inclination_deg": 111,
                          "height_mm": 700},
               "joint": {"kind": "through", "gap_mm": 0.4}, "groove": {"rule": "none"},
               "tilt": "free"}],
    "kerf_mm": 0, "datum": "seam", "torch": {"min_deg": -85, "max_deg": 85},
    "sampling": {"uniform_points": 90}})"));
  EXPECT_EQ(text(refused.body, "code"), "edge_crosses") << refused.outcome.body.substr(0, 300);
  EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/holes/0/branch");
  const auto frame = post("/v1/frames", *api::parse(R"({
    "members": [{"id": "chord", "start_mm": [0, 0, -700], "end_mm": [0, 0, 700],
                 "outer_diameter_mm": 180, "wall_mm": 20.7, "priority": 0, "up": [1, 0, 0]},
                {"id": "brace", "start_mm": [0, 0, 0], "end_mm": [840, 0, -322],
                 "outer_diameter_mm": 134.2, "wall_mm": 20, "priority": 1}],
    "joints": [{"between": ["brace", "chord"], "kind": "set_in", "gap_mm": 0.4}],
    "defaults": {"root_surface": "inner", "groove": {"rule": "none"},
                 "smoothing": {"method": "none"}, "tilt": "free"},
    "kerf_mm": 0, "torch": {"min_deg": -85, "max_deg": 85}, "sampling": {"uniform_points": 90}})"));
  EXPECT_EQ(text(frame.body, "warnings/0/code"), "no_part") << frame.outcome.body.substr(0, 300);
  EXPECT_NE(text(frame.body, "warnings/0/detail").find("edge_crosses at /members/1:"),
            std::string::npos);
  EXPECT_EQ(text(frame.body, "result/cut_list/0/verdict"), "none");
}

TEST(Parts, ImpossibleCutsNameTheField) {
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
  EXPECT_EQ(refusal(holes, "/members/2/joints/0"), "no_contact");
  holes = with(without(holes, "members/2/joints"), "holes/1/joint",
               *api::parse(R"({"kind": "set_in", "gap_mm": 1.5})"));
  EXPECT_EQ(refusal(holes, "/holes/1/member"), "no_contact");
  EXPECT_EQ(refusal(with(chord(), "torch", *api::parse(R"({"max_deg": 1})")), "/torch/max_deg"),
            "torch_range");
}

// A square end's kerf lies wholly beyond it: the blank is longer by the additional kerf.
TEST(Parts, AnEndHasAKerfOfItsOwn) {
  auto request =
      *api::parse(R"({"target": {"outer_diameter_mm": 60.3, "wall_mm": 4, "length_mm": 500},
    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "kerf_mm": 1})");
  const auto blank = [&](double start, double finish) {
    auto one = with(request, "ends/start/kerf_mm", Json{start});
    one = with(one, "ends/finish/kerf_mm", Json{finish});
    const auto answer = post("/v1/parts", one);
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 500);
    EXPECT_EQ(at(answer.body, "request/ends/start/kerf_mm"), Json{start});
    return number(answer.body, "result/lengths/blank_mm");
  };
  EXPECT_NEAR(blank(3, 1) - blank(1, 1), 2.0, 1e-9);
  EXPECT_NEAR(blank(3, 2.5) - blank(1, 1), 3.5, 1e-9);
  EXPECT_EQ(blank(1, 1), number(post("/v1/parts", request).body, "result/lengths/blank_mm"));
  const auto body = api::dump(with(request, "ends/start/kerf_mm", Json{3.0}));
  const auto program = post("/v1/parts", std::string_view(body), "format=gcode&speed_mm_min=600");
  EXPECT_NE(program.outcome.body.find("kerf 1, 3 mm"), std::string::npos);
}

}  // namespace
}  // namespace tubecut::testing
