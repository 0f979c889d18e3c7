#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "api/catalog/tube_sizes.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

constexpr const char* kNodes = "/v1/nodes";
constexpr const char* kTables = "/v1/bevel-tables";
constexpr const char* kCurves = "/v1/intersections";

Json point(double x, double y, double z) { return Json{Json::Array{x, y, z}}; }

Json member(const std::string& id, Json start, Json end, double diameter, double wall = 5.0) {
  return Json{Json::Object{{"id", id},
                           {"start_mm", std::move(start)},
                           {"end_mm", std::move(end)},
                           {"outer_diameter_mm", diameter},
                           {"wall_mm", wall}}};
}

Json node(Json::Array members, double within = 50.0) {
  return Json{Json::Object{{"members", std::move(members)},
                           {"connect", Json{Json::Object{{"within_mm", within}}}}}};
}

std::string code(const Posted& answer) {
  return answer.outcome.error ? text(answer.body, "code") : "";
}

const Json& end_of(const Posted& answer, std::size_t index) {
  return at(answer.body, "result/ends").as<Json::Array>()->at(index);
}

std::size_t cuts(const Posted& answer, std::size_t index) {
  return at(end_of(answer, index), "cut_by").as<Json::Array>()->size();
}

bool warned(const Posted& answer, const std::string& warning, const std::string& pointer) {
  for (const auto& w : *at(answer.body, "warnings").as<Json::Array>())
    if (text(w, "code") == warning && text(w, "pointer") == pointer) return true;
  return false;
}

TEST(Nodes, EveryExampleRuns) {
  for (const char* name : {"k-joint-from-centre-lines", "k-joint-with-tables",
                           "source-002-offset-pair", "mitre", "stated-mitre"}) {
    const auto answer = post(kNodes, example("nodes/" + std::string(name) + ".json"));
    EXPECT_FALSE(answer.outcome.error) << name << ": " << answer.outcome.body.substr(0, 1500);
  }
}

TEST(Nodes, KJointFromCentreLines) {
  const auto answer = post(kNodes, example("nodes/k-joint-from-centre-lines.json"));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body;
  EXPECT_EQ(cuts(answer, 0), 0U);  // the chord is not cut
  EXPECT_EQ(cuts(answer, 2), 1U);  // B1 by C1
  EXPECT_EQ(cuts(answer, 4), 2U);  // B2 by C1, then B1
  EXPECT_EQ(text(end_of(answer, 4), "cut_by/0/member"), "C1");
  EXPECT_EQ(text(end_of(answer, 4), "cut_by/1/member"), "B1");
  EXPECT_EQ(number(end_of(answer, 4), "cut_by/0/placement/clocking_deg"), 0.0);
  EXPECT_NEAR(number(end_of(answer, 2), "cut_by/0/eccentricity_mm"), 12.0, 1e-12);
  EXPECT_NEAR(number(end_of(answer, 2), "cut_by/0/gap_mm"), 12.0, 1e-12);
  EXPECT_EQ(text(answer.body, "verdict/status"), "ok");  // far ends are free and no fault
  EXPECT_TRUE(at(answer.body, "warnings").as<Json::Array>()->empty());
  EXPECT_EQ(at(end_of(answer, 4), "profiles").as<Json::Array>()->size(), 2U);
}

// C1 is 219.1 mm thick, B1's end 40 mm along it and 12 mm from its axis; within 50 mm both join.
TEST(Nodes, AFreeEndIsReportedIfAMemberIsNear) {
  const auto moved = [](double up) {
    return post(kNodes, with(example("nodes/k-joint-from-centre-lines.json"), "members/1/start_mm",
                             point(-40.0, 12.0, up)));
  };
  EXPECT_FALSE(warned(moved(100.0), "free_end", "/members/1/start_mm"));
  for (const double near : {170.0, 470.0})
    EXPECT_TRUE(warned(moved(near), "free_end", "/members/1/start_mm")) << near;
  EXPECT_FALSE(warned(moved(490.0), "free_end", "/members/1/start_mm"));
  const auto answer = moved(300.0);
  EXPECT_NE(answer.outcome.body.find("B1 meets no member here, and misses C1 by 190.6"),
            std::string::npos)
      << answer.outcome.body.substr(0, 2000);
}

// A node end and its own placements, sent as cutters, give the same curve to the bit.
TEST(Nodes, NodeInsteadOfTargetAndCutters) {
  auto request = example("bevel-tables/k-joint-from-centre-lines.json");
  const auto by_node = post(kTables, request);
  ASSERT_FALSE(by_node.outcome.error) << by_node.outcome.body.substr(0, 1500);
  const auto node = at(request, "node");
  const auto solved = post(kNodes, without(without(node, "member"), "end"));
  ASSERT_FALSE(solved.outcome.error);
  Json::Array cutters;
  const double diameters[] = {219.1, 114.3};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& placed = at(end_of(solved, 4), "cut_by/" + std::to_string(i) + "/placement");
    auto tube = *placed.as<Json::Object>();
    tube.insert(tube.begin(), {{"kind", "tube"}, {"outer_diameter_mm", diameters[i]}});
    cutters.emplace_back(std::move(tube));
  }
  request = without(request, "node");
  request = with(request, "target", Json{Json::Object{{"size", "CHS 114.3x5"}}});
  request = with(request, "cutters", Json{cutters});
  const auto by_cutters = post(kTables, request);
  ASSERT_FALSE(by_cutters.outcome.error) << by_cutters.outcome.body.substr(0, 1500);
  const auto a = numbers(by_node.body, "result/points/z_outer_mm");
  const auto b = numbers(by_cutters.body, "result/points/z_outer_mm");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9);
  EXPECT_EQ(text(by_node.body, "result/cutter_ids/0"), "C1");
  EXPECT_EQ(text(by_node.body, "result/cutter_ids/1"), "B1");
}

TEST(Nodes, ErrorsNameTheMembers) {
  const auto chords = node({member("C1", point(-900, 0, 40), point(900, 0, 40), 100),
                            member("C2", point(-900, 0, -40), point(900, 0, -40), 100),
                            member("B", point(0, 0, 0), point(0, 900, 0), 60)});
  const auto ambiguous = post(kNodes, chords);
  EXPECT_EQ(code(ambiguous), "ambiguous_connection");
  EXPECT_EQ(text(ambiguous.body, "errors/0/pointer"), "/members/2/start_mm");
  EXPECT_EQ(text(ambiguous.body, "errors/0/got"), "C1, C2");
  // Named, or ranked, it is an answer.
  EXPECT_EQ(code(post(kNodes, with(chords, "members/0/priority", 0.0))), "ambiguous_connection");
  EXPECT_EQ(code(post(kNodes, with(chords, "members/1/priority", 1.0))), "");
  const auto link = Json{Json::Array{Json{
      Json::Object{{"member", "B"}, {"end", "start"}, {"to", Json{Json::Array{"C1", "C2"}}}}}}};
  const auto named = post(kNodes, with(chords, "connect", link));
  EXPECT_EQ(code(named), "") << named.outcome.body;
  EXPECT_EQ(cuts(named, 4), 2U);

  const auto unknown = post(kNodes, with(with(chords, "connect", link), "connect/0/to/0", "C3"));
  EXPECT_EQ(text(unknown.body, "errors/0/pointer"), "/connect/0/to/0");
  EXPECT_EQ(text(unknown.body, "errors/0/hint"), "did you mean C1?");
  const auto self = post(kNodes, with(with(chords, "connect", link), "connect/0/to/0", "B"));
  EXPECT_EQ(text(self.body, "errors/0/code"), "bad_choice");
  const auto twice = post(kNodes, with(chords, "members/1/id", "C1"));
  EXPECT_EQ(text(twice.body, "errors/0/pointer"), "/members/1/id");
  EXPECT_EQ(text(twice.body, "errors/0/hint"), "duplicate: another member has this id");
  const auto nowhere = post(kNodes, with(chords, "members/2/end_mm", point(0, 0, 0)));
  EXPECT_EQ(code(nowhere), "zero_length");
  EXPECT_EQ(text(nowhere.body, "errors/0/pointer"), "/members/2");
  const auto up =
      post(kNodes, with(with(chords, "members/1/priority", 1.0), "members/2/up", point(0, 2, 0)));
  EXPECT_EQ(code(up), "bad_reference_direction");
  EXPECT_EQ(text(up.body, "errors/0/pointer"), "/members/2/up");
}

/// The request with the K joint's options for tables.
Json with_tables(const Json& request) {
  const auto options = without(example("bevel-tables/k-joint-from-centre-lines.json"), "node");
  return with(with(request, "include", Json{Json::Array{"tables"}}), "tables", options);
}

// The table inside a node's answer equals that of the same end by itself.
TEST(Nodes, TablesOfEveryEnd) {
  const auto one = example("bevel-tables/k-joint-from-centre-lines.json");
  const auto alone = post(kTables, one);
  ASSERT_FALSE(alone.outcome.error) << alone.outcome.body.substr(0, 900);
  const auto request = with_tables(without(without(at(one, "node"), "member"), "end"));
  const auto answer = post(kNodes, request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(api::dump(at(end_of(answer, 4), "table/points")),
            api::dump(at(alone.body, "result/points")));
  EXPECT_EQ(api::dump(at(end_of(answer, 4), "table/events")),
            api::dump(at(alone.body, "result/events")));
  EXPECT_NE(end_of(answer, 2).find("table"), nullptr);
  EXPECT_EQ(end_of(answer, 0).find("table"), nullptr);  // the chord is not cut
  EXPECT_EQ(at(end_of(answer, 4), "profiles").as<Json::Array>()->size(), 0U);
  bool proved = false;
  for (const auto& check : *at(answer.body, "verification/checks").as<Json::Array>())
    proved = proved || text(check, "name") == "penetration";
  EXPECT_TRUE(proved);
}

TEST(Nodes, FailedEndDoesNotAffectOthers) {
  const auto request =
      with(with_tables(node({member("C", point(-900, 0, 0), point(900, 0, 0), 120),
                             member("steep", point(0, 0, 0), point(0, 0, 900), 60),
                             member("flat", point(0, 0, 0), point(900, 0, 420), 60)})),
           "tables/torch", Json{Json::Object{{"min_deg", -60.0}, {"max_deg", 60.0}}});
  const auto answer = post(kNodes, request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_NE(end_of(answer, 2).find("table"), nullptr);
  EXPECT_EQ(end_of(answer, 4).find("table"), nullptr);
  EXPECT_TRUE(warned(answer, "no_table", "/members/2/start_mm"));
  EXPECT_EQ(text(answer.body, "verdict/status"), "review");
}

TEST(Nodes, TablesGoWithTheirName) {
  const auto request = with_tables(example("nodes/mitre.json"));
  EXPECT_EQ(code(post(kNodes, request)), "");
  const auto unnamed = post(kNodes, without(request, "include"));
  EXPECT_EQ(text(unnamed.body, "errors/0/pointer"), "/include");
  const auto unasked = post(kNodes, without(request, "tables"));
  EXPECT_EQ(text(unasked.body, "errors/0/pointer"), "/tables");
  EXPECT_EQ(text(unasked.body, "errors/0/code"), "missing_field");
  const auto twice = post(kNodes, with(request, "include", Json{Json::Array{"tables", "tables"}}));
  EXPECT_EQ(text(twice.body, "errors/0/pointer"), "/include/1");
  const auto inside = post(kNodes, without(request, "tables/kerf_mm"));
  EXPECT_EQ(text(inside.body, "errors/0/pointer"), "/tables/kerf_mm");
  const auto zones = post(
      kNodes,
      with(request, "tables/groove",
           Json{Json::Object{{"rule", "zones"},
                             {"zones", Json{Json::Array{Json{Json::Object{
                                           {"id", "A"},
                                           {"dihedral_deg", Json{Json::Array{90.0, 30.0}}},
                                           {"groove_deg", Json{Json::Array{30.0, 30.0}}}}}}}}}}));
  EXPECT_EQ(text(zones.body, "errors/0/pointer"), "/tables/groove/zones/0/dihedral_deg")
      << zones.outcome.body.substr(0, 600);
}

TEST(Nodes, AnEndThatIsNotCutHasNoTable) {
  const auto request =
      with(example("bevel-tables/k-joint-from-centre-lines.json"), "node/member", "C1");
  const auto answer = post(kTables, request);
  EXPECT_EQ(code(answer), "no_contact");
  EXPECT_EQ(text(answer.body, "errors/0/pointer"), "/node/members/0/start_mm");
}

TEST(Nodes, AStatedMitreIsAMitre) {
  const auto request = example("nodes/stated-mitre.json");
  const auto answer = post(kNodes, request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  for (const std::size_t end : {1U, 2U}) {  // the leg's finish, the rail's start
    ASSERT_EQ(cuts(answer, end), 1U);
    EXPECT_EQ(end_of(answer, end).find("cut_by")->as<Json::Array>()->at(0).find("placement"),
              nullptr);
    EXPECT_EQ(text(end_of(answer, end), "cut_by/0/joint/kind"), "mitre");
    // The rail rises by atan 1/3 from the leg's square: the plane tilts by half of the rest.
    EXPECT_NEAR(number(end_of(answer, end), "cut_by/0/plane/normal/2"),
                std::sin(0.5 * (std::acos(-1.0) / 2 + std::atan(1.0 / 3))), 1e-12);
  }
  EXPECT_FALSE(warned(answer, "ghost_contact", "/members/1/start_mm"));
}

TEST(Nodes, OverlapsAreReportedWithDepthAndPosition) {
  auto request = node({member("C", point(-900, 0, 0), point(900, 0, 0), 168.3, 8),
                       member("B", point(0, 0, 0), point(600, 0, 600), 88.9),
                       member("again", point(0, 0, 0), point(600, 0, 600), 88.9)});
  const auto answer = post(kNodes, request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_TRUE(warned(answer, "members_overlap", "/members/1"));
  EXPECT_FALSE(warned(answer, "members_overlap", "/members/2")) << "the pair is told once";
  ASSERT_EQ(at(answer.body, "result/overlaps").as<Json::Array>()->size(), 1U);
  EXPECT_EQ(text(answer.body, "result/overlaps/0/between/0"), "B");
  EXPECT_EQ(text(answer.body, "result/overlaps/0/between/1"), "again");
  EXPECT_NEAR(number(answer.body, "result/overlaps/0/depth_mm"), 5.0, 1e-6);
  EXPECT_EQ(text(answer.body, "verdict/status"), "review");
  // A request for only the end of one member reports it too.
  Json end{Json::Object{{"members", at(request, "members")},
                        {"connect", at(request, "connect")},
                        {"member", Json{"B"}},
                        {"end", Json{"start"}}}};
  const auto curves = post(kCurves, Json{Json::Object{{"node", end}}});
  ASSERT_FALSE(curves.outcome.error) << curves.outcome.body.substr(0, 800);
  EXPECT_TRUE(warned(curves, "members_overlap", "/node/members/1"));
}

TEST(Nodes, GhostConsumedOpenAndParallel) {
  // The brace is cut by a stub that ends within the contact, from x 18 to 102; or before it.
  const auto stub = [](double to) {
    return post(kNodes, node({member("stub", point(0, 0, 0), point(to, 0, 0), 120),
                              member("B", point(0, 0, 0), point(600, 0, 600), 60)}));
  };
  const auto ghost = stub(40);
  ASSERT_EQ(code(ghost), "") << ghost.outcome.body;
  EXPECT_TRUE(warned(ghost, "ghost_contact", "/members/1/start_mm"));
  EXPECT_NEAR(number(end_of(ghost, 2), "cut_by/0/missing_mm"), 60 + 30 * std::sqrt(2.0) - 40, 0.01);
  const auto absent = stub(5);
  EXPECT_TRUE(warned(absent, "free_end", "/members/1/start_mm"));
  EXPECT_EQ(cuts(absent, 2), 0U);
  const auto consumed = post(kNodes, node({member("C", point(-900, 0, 0), point(900, 0, 0), 300),
                                           member("B", point(0, 0, 0), point(0, 0, 140), 60)}));
  EXPECT_TRUE(warned(consumed, "end_consumed", "/members/1/start_mm"));
  EXPECT_TRUE(*at(end_of(consumed, 2), "consumed").as<bool>());
  const auto open = post(kNodes, node({member("C", point(-900, 0, 0), point(900, 0, 0), 60),
                                       member("B", point(0, 45, 0), point(0, 45, 900), 59)}));
  EXPECT_TRUE(warned(open, "end_open", "/members/1/start_mm"));
  const auto parallel = post(kNodes, node({member("C1", point(-900, 0, 0), point(0, 0, 0), 60),
                                           member("C2", point(-90, 0, 0), point(900, 0, 0), 60)}));
  EXPECT_TRUE(warned(parallel, "parallel_members", "/members/1/start_mm"));
  EXPECT_EQ(text(parallel.body, "verdict/status"), "review");
}

/// A Warren truss of `count` members: two chords in panels and the braces between them.
Json truss(std::size_t count) {
  Json::Array members;
  const double panel = 2000, height = 1800;
  const auto chord = [&](const char* name, double z, double x0, double x1) {
    auto m = member(name, point(x0, 0, z), point(x1, 0, z), 219.1, 8);
    m.as<Json::Object>()->emplace_back("priority", 0.0);
    members.push_back(std::move(m));
  };
  const auto braces = count - 2;
  const double length = panel * static_cast<double>(braces / 2 + 1);
  chord("bottom", 0, -500, length);
  chord("top", height, -500, length);
  for (std::size_t i = 0; i < braces; ++i) {
    const double x = panel * static_cast<double>(i / 2);
    const bool up = i % 2 == 0;
    auto m = member("B" + std::to_string(i), point(up ? x : x + panel, 6, up ? 0 : 0),
                    point(x + panel / 2, 6, height), 88.9, 5);
    m.as<Json::Object>()->emplace_back("priority", 1.0);
    members.push_back(std::move(m));
  }
  return node(std::move(members), 20);
}

TEST(Nodes, ATrussOfAThousandMembers) {
  const auto answer = post(kNodes, truss(1000));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  ASSERT_EQ(at(answer.body, "result/ends").as<Json::Array>()->size(), 2000U);
  for (std::size_t i = 4; i < 2000; ++i) EXPECT_GE(cuts(answer, i), 1U) << i;
  EXPECT_LE(cuts(answer, 1000), 2U);
}

TEST(Sizes, NamesGiveTheNumbersOfTheStandards) {
  EXPECT_EQ(api::find_tube_size("NPS 4 SCH 40")->outer_diameter, 114.3);
  EXPECT_EQ(api::find_tube_size("NPS 4 SCH 40")->wall, 6.02);
  EXPECT_EQ(api::find_tube_size("CHS 114.3x6.3")->wall, 6.3);
  EXPECT_EQ(api::find_tube_size("nps 4 sch 40"), nullptr);
  std::vector<std::string> names;
  ASSERT_FALSE(api::tube_sizes().empty());
  for (const auto& size : api::tube_sizes()) {
    EXPECT_GT(size.wall, 0.0);
    EXPECT_LT(size.wall, size.outer_diameter / 2.0) << size.name;
    EXPECT_EQ(size.standard == "ASME B36.10M-2018", size.name.starts_with("NPS ")) << size.name;
    names.push_back(size.name);
  }
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

// Masses per metre printed in the same standards, to three or four figures, tie diameter and wall
// together: 0.0246615 (D - t) t.
TEST(Sizes, MassesPerMetreAgree) {
  const struct {
    const char* size;
    double kg_per_m;
  } kRows[] = {{"NPS 1/2 SCH 40", 1.27}, {"NPS 1 SCH 80", 3.24},   {"NPS 2 SCH 40", 5.44},
               {"NPS 3 SCH 80", 15.27},  {"NPS 4 SCH 40", 16.08},  {"NPS 4 SCH 160", 33.54},
               {"NPS 6 SCH 40", 28.26},  {"NPS 8 SCH 40", 42.55},  {"NPS 10 SCH 40", 60.29},
               {"NPS 12 STD", 73.86},    {"NPS 16 STD", 93.27},    {"NPS 24 XS", 187.07},
               {"CHS 60.3x4", 5.55},     {"CHS 88.9x5", 10.3},     {"CHS 114.3x6.3", 16.8},
               {"CHS 168.3x10", 39.0},   {"CHS 219.1x12.5", 63.7}, {"CHS 323.9x16", 121.0},
               {"CHS 508x20", 241.0},    {"CHS 21.3x2.3", 1.08},   {"CHS 26.9x3.2", 1.87},
               {"CHS 48.3x5", 5.34},     {"CHS 76.1x5", 8.77},     {"CHS 139.7x8", 26.0},
               {"CHS 193.7x10", 45.3},   {"CHS 273x16", 101.0},    {"CHS 406.4x20", 191.0},
               {"CHS 610x12.5", 184.0},  {"CHS 711x20", 341.0},    {"NPS 5 SCH 40", 21.77},
               {"NPS 18 STD", 105.17},   {"NPS 14 SCH 40", 94.55}, {"NPS 20 SCH 40", 183.43},
               {"CHS 42.4x2", 1.99},     {"CHS 48.3x2", 2.28},     {"CHS 60.3x3", 4.24},
               {"CHS 26.9x2", 1.23},     {"CHS 33.7x2.5", 1.92},   {"CHS 114.3x3", 8.23},
               {"CHS 60.3x3.6", 5.03},   {"CHS 76.1x3.6", 6.42},   {"CHS 114.3x4.5", 12.2},
               {"CHS 60.3x4.5", 6.19},   {"CHS 139.7x5.4", 17.9},  {"CHS 165.1x5", 19.8}};
  for (const auto& row : kRows) {
    const auto* size = api::find_tube_size(row.size);
    ASSERT_NE(size, nullptr) << row.size;
    const double kg = 0.0246615 * (size->outer_diameter - size->wall) * size->wall;
    EXPECT_NEAR(kg, row.kg_per_m, 0.005 * row.kg_per_m + 0.006) << row.size;
  }
}

TEST(Sizes, ServeTargetsAndCutters) {
  auto request = example("intersections/source-000-table-1.json");
  request = with(without(without(request, "target/outer_diameter_mm"), "target/wall_mm"),
                 "target/size", "NPS 2 SCH 40");
  const auto good = post(kCurves, request);
  ASSERT_FALSE(good.outcome.error) << good.outcome.body.substr(0, 900);
  EXPECT_EQ(number(good.body, "result/profiles/1/radius_mm"), 30.15);
  const auto bad = post(kCurves, with(request, "target/size", "NPS 2 SCH 41"));
  EXPECT_EQ(text(bad.body, "errors/0/code"), "unknown_size");
  EXPECT_EQ(text(bad.body, "errors/0/hint"), "did you mean NPS 2 SCH 40?");
  const auto both = post(kCurves, with(request, "target/wall_mm", 5.0));
  EXPECT_EQ(text(both.body, "errors/0/code"), "exclusive_fields");
}

}  // namespace
}  // namespace tubecut::testing
