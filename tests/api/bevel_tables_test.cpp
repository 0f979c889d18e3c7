#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr const char* kPath = "/v1/bevel-tables";

api::Json table_1() { return example("bevel-tables/source-000-table-1.json"); }

double largest_step(const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i)
    worst = std::max(worst, std::abs(b[(i + 1) % b.size()] - b[i]));
  return worst;
}

// docs/theory/intersections-and-bevels.md, section 7: Table 1 with root inner, contact inner.
TEST(BevelTables, EchoAnglesAsTheyWereSent) {
  const auto request = with(example("bevel-tables/source-000-table-1.json"),
                            "sampling/uniform_points", api::Json{8.0});
  for (int tenth = 200; tenth <= 1600; tenth += 7) {
    const double angle = tenth / 10.0;
    const auto sent = with(with(request, "cutters/0/inclination_deg", api::Json{angle}),
                           "cutters/1/clocking_deg", api::Json{angle + 100.0});
    const auto answer = post("/v1/bevel-tables", sent);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 500);
    EXPECT_EQ(number(answer.body, "request/cutters/0/inclination_deg"), angle);
    EXPECT_EQ(number(answer.body, "request/cutters/1/clocking_deg"), angle + 100.0);
  }
}

TEST(BevelTables, Table1EqualsTheListOfTheTheory) {
  const auto answer = post(kPath, table_1());
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 2000);
  const auto& result = at(answer.body, "result");
  const auto b = numbers(result, "points/b_deg");
  const auto raw = numbers(result, "points/b_raw_deg");
  const auto required = numbers(result, "points/b_required_deg");
  ASSERT_EQ(b.size(), 360u);
  std::vector<double> input(360);
  int above = 0;
  for (std::size_t i = 0; i < 360; ++i) {
    input[i] = std::max(raw[i], required[i]);
    above += required[i] > raw[i] + 1e-9;
  }
  EXPECT_EQ(above, 1);
  EXPECT_NEAR(largest_step(input), 44.259, 5e-4);
  EXPECT_NEAR(largest_step(b), 2.618, 5e-4);
  EXPECT_NEAR(*std::max_element(b.begin(), b.end()), 72.59, 5e-3);
  EXPECT_NEAR(number(result, "length_mm"), 244.5759, 5e-5);
  EXPECT_NEAR(number(result, "developed_length_mm"), 188.4956, 5e-5);
  double area = 0.0;
  for (std::size_t i = 0; i < 360; ++i) area += (b[i] - input[i]) * 188.4955592 / 360.0;
  EXPECT_NEAR(area, 401.66, 0.2);
  const double junctions[] = {8.15032, 96.77994, 222.07934, 258.49203, 327.60426};
  const auto& events = *at(result, "events").as<api::Json::Array>();
  std::size_t inner = 0;
  for (const auto& event : events) {
    if (text(event, "surface") != "inner") continue;
    ASSERT_LT(inner, std::size(junctions));
    EXPECT_NEAR(number(event, "phi_deg"), junctions[inner++], 5e-6);
  }
  EXPECT_EQ(inner, std::size(junctions));
  const auto& mutations = *at(result, "mutations").as<api::Json::Array>();
  const double steps[][2] = {{8, -44.259}, {222, 18.075}, {258, -12.458}, {327, 29.668}};
  ASSERT_EQ(mutations.size(), std::size(steps));
  for (std::size_t i = 0; i < mutations.size(); ++i) {
    EXPECT_NEAR(number(mutations[i], "phi_deg"), steps[i][0], 1e-9);
    EXPECT_NEAR(number(mutations[i], "step_deg"), steps[i][1], 5e-4);
  }
}

TEST(BevelTables, Table1WithoutRefinementHasTheListedArea) {
  const auto answer = post(kPath, with(table_1(), "smoothing/refine", false));
  const auto b = numbers(answer.body, "result/points/b_deg");
  const auto raw = numbers(answer.body, "result/points/b_raw_deg");
  const auto required = numbers(answer.body, "result/points/b_required_deg");
  double area = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i)
    area += (b[i] - std::max(raw[i], required[i])) * 188.4955592 / 360.0;
  EXPECT_NEAR(area, 483.373, 5e-4);
}

TEST(BevelTables, EveryExampleRuns) {
  for (const char* name : {"source-000-table-1", "source-000-table-1-as-published",
                           "source-002-offset-pair", "table-1-five-axis-at-600-mm-min", "mitre",
                           "k-joint-from-centre-lines", "zones", "table-1-torch-45-deg"}) {
    const auto answer = post(kPath, example("bevel-tables/" + std::string(name) + ".json"));
    EXPECT_FALSE(answer.outcome.error) << name << ": " << answer.outcome.body.substr(0, 1500);
  }
}

TEST(BevelTables, AsPublishedHasThePublishedJumps) {
  const auto answer = post(kPath, example("bevel-tables/source-000-table-1-as-published.json"));
  ASSERT_FALSE(answer.outcome.error);
  const auto raw = numbers(answer.body, "result/points/b_raw_deg");
  const double jumps[][2] = {{16, 16.16}, {102, 25.58}, {216, -41.79}, {260, 5.58}, {319, -20.33}};
  for (const auto& jump : jumps) {
    const auto i = static_cast<std::size_t>(jump[0]);
    EXPECT_NEAR(raw[i + 1] - raw[i], jump[1], 5e-3);
  }
  EXPECT_EQ(text(answer.body, "result/b_sign"), "inward");
}

TEST(BevelTables, ATorchOf45DegreesIsReviewedAndAcceptMayReject) {
  const auto request = example("bevel-tables/table-1-torch-45-deg.json");
  const auto answer = post(kPath, request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  const auto gap = numbers(answer.body, "result/points/gap_mm");
  EXPECT_NEAR(*std::max_element(gap.begin(), gap.end()), 2.174, 5e-3);
  EXPECT_EQ(text(answer.body, "verdict/status"), "review");
  EXPECT_GT(number(answer.body, "result/torch_binds/0/root_gap_mm"), 0.0);
  const auto accept = api::Json{api::Json::Object{{"max_root_gap_mm", 2.0}}};
  EXPECT_EQ(text(post(kPath, with(request, "accept", accept)).body, "verdict/status"), "reject");
}

TEST(BevelTables, ZonesNameEveryPoint) {
  const auto request = example("bevel-tables/zones.json");
  const auto answer = post(kPath, request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  const auto dihedral = numbers(answer.body, "result/points/dihedral_deg");
  const auto& zone = *at(answer.body, "result/points/zone").as<api::Json::Array>();
  ASSERT_EQ(zone.size(), dihedral.size());
  for (std::size_t i = 0; i < zone.size(); ++i)
    EXPECT_EQ(*zone[i].as<std::string>(), dihedral[i] > 135  ? "A"
                                          : dihedral[i] > 75 ? "B"
                                          : dihedral[i] > 40 ? "C"
                                                             : "D");
  EXPECT_EQ(numbers(answer.body, "result/points/z_face_mm").size(), zone.size());
  const auto csv = post(kPath, api::dump(request), "format=csv").outcome.body;
  EXPECT_NE(csv.find(",z_face_mm,b_face_deg,zone\r\n"), std::string::npos);
  EXPECT_EQ(csv.substr(csv.size() - 4), "," + *zone.back().as<std::string>() + "\r\n");
  const auto svg = post(kPath, api::dump(request), "format=svg").outcome.body;
  EXPECT_NE(svg.find(">Zones: dihedral and groove angle<"), std::string::npos);
  EXPECT_NE(svg.find(">C</text>"), std::string::npos);
  const auto gap = post(kPath, with(request, "groove/zones/1/dihedral_deg/0", 80.0));
  EXPECT_EQ(text(gap.body, "code"), "out_of_range");
  EXPECT_EQ(text(gap.body, "errors/0/pointer"), "/groove/zones/1/dihedral_deg");
}

TEST(BevelTables, EchoedRequestGivesTheSameAnswer) {
  const auto first = post(kPath, table_1());
  const auto second = post(kPath, at(first.body, "request"));
  EXPECT_EQ(first.outcome.body, second.outcome.body);
}

}  // namespace
}  // namespace tubecut::testing
