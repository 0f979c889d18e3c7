#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr const char* kPath = "/v1/holes";

api::Json set_in() { return example("holes/set-in-branch.json"); }

TEST(Holes, EveryExampleRunsAndFits) {
  for (const char* name : {"set-in-branch", "set-on-branch", "through-brace"}) {
    const auto request = example("holes/" + std::string(name) + ".json");
    const auto answer = post(kPath, request);
    ASSERT_FALSE(answer.outcome.error) << name << ": " << answer.outcome.body.substr(0, 1500);
    const double gap = number(request, "joint/gap_mm");
    const auto& holes = *at(answer.body, "result/holes").as<api::Json::Array>();
    EXPECT_EQ(holes.size(), name == std::string("through-brace") ? 2u : 1u);
    for (const auto& hole : holes)
      for (const double root : numbers(hole, "fit_up/root_mm")) EXPECT_NEAR(root, gap, 1e-9);
  }
}

// One request fits both pieces: the branch's cutter goes unchanged into its bevel table.
TEST(Holes, TheBranchOfTheAnswerIsABevelTable) {
  const auto hole = post(kPath, example("holes/set-on-branch.json"));
  ASSERT_FALSE(hole.outcome.error);
  auto request = example("bevel-tables/source-000-table-1.json");
  request = with(request, "target/outer_diameter_mm", 114.3);
  request = with(request, "target/wall_mm", 6.3);
  request =
      with(request, "cutters", api::Json{api::Json::Array{at(hole.body, "result/branch/cutter")}});
  request = with(request, "sampling", *api::parse(R"({"uniform_points": 72})"));
  request = with(request, "smoothing", *api::parse(R"({"method": "none"})"));
  request = with(request, "groove", at(hole.body, "request/groove"));
  const auto table = post("/v1/bevel-tables", request);
  ASSERT_FALSE(table.outcome.error) << table.outcome.body.substr(0, 800);
  const auto inner = numbers(hole.body, "result/branch/points/z_inner_mm");
  const auto outer = numbers(hole.body, "result/branch/points/z_outer_mm");
  const auto want_inner = numbers(table.body, "result/points/z_inner_mm");
  const auto want_outer = numbers(table.body, "result/points/z_outer_mm");
  ASSERT_EQ(inner.size(), want_inner.size());
  for (std::size_t i = 0; i < inner.size(); ++i) {
    EXPECT_NEAR(inner[i], want_inner[i], 1e-10) << i;
    EXPECT_NEAR(outer[i], want_outer[i], 1e-9) << i;
  }
}

TEST(Holes, EchoedRequestGivesTheSameAnswer) {
  const auto first = post(kPath, set_in());
  ASSERT_FALSE(first.outcome.error) << first.outcome.body.substr(0, 800);
  EXPECT_EQ(first.outcome.body, post(kPath, at(first.body, "request")).outcome.body);
}

TEST(Holes, OtherFormats) {
  const auto body = api::dump(set_in());
  const auto csv = post(kPath, body, "format=csv");
  EXPECT_TRUE(csv.outcome.body.starts_with(
      "# verdict: ok\r\n# b_sign: outer_edge_to_plus_z\r\nside,branch_phi_deg,"));
  const auto svg = post(kPath, body, "format=svg");
  EXPECT_NE(svg.outcome.body.find("<svg"), std::string::npos);
}

std::string refusal(const api::Json& request, std::string_view pointer) {
  const auto answer = post(kPath, request);
  if (!answer.outcome.error) return "no error";
  const auto& errors = *at(answer.body, "errors").as<api::Json::Array>();
  for (const auto& one : errors)
    if (text(one, "pointer") == pointer) return text(one, "code");
  return answer.outcome.body;
}

TEST(Holes, EveryFieldIsChecked) {
  const auto good = set_in();
  EXPECT_EQ(refusal(without(good, "kerf_mm"), "/kerf_mm"), "missing_field");
  EXPECT_EQ(refusal(without(good, "groove"), "/groove"), "missing_field");
  EXPECT_EQ(refusal(without(good, "joint/kind"), "/joint/kind"), "missing_field");
  EXPECT_EQ(refusal(with(good, "joint/gap_mm", -1.0), "/joint/gap_mm"), "out_of_range");
  EXPECT_EQ(refusal(with(good, "joint/depth_mm", 84.15), "/joint/depth_mm"), "out_of_range");
  EXPECT_EQ(
      refusal(with(with(good, "joint/kind", "through"), "joint/depth_mm", 5.0), "/joint/depth_mm"),
      "unsupported_combination");
  EXPECT_EQ(refusal(with(good, "branch/wall_mm", 44.45), "/branch/wall_mm"), "out_of_range");
  EXPECT_EQ(refusal(with(good, "branch/axis", api::Json{api::Json::Object{}}), "/branch/axis"),
            "exclusive_fields");
  EXPECT_EQ(refusal(with(good, "tilt", "both"), "/tilt"), "bad_choice");
  EXPECT_EQ(refusal(with(good, "groove/rule", "zones"), "/groove/rule"), "bad_choice");
  EXPECT_EQ(refusal(with(good, "chord/wal_mm", 3.0), "/chord/wal_mm"), "unknown_field");
  EXPECT_EQ(refusal(with(good, "branch/inclination_deg", 1e-6), "/branch/inclination_deg"),
            "parallel_axes");
  EXPECT_EQ(refusal(with(good, "branch/offset_mm", 500.0), "/branch"), "no_contact");
  EXPECT_EQ(refusal(with(good, "branch/outer_diameter_mm", 168.3), "/branch"), "open_profile");
}

}  // namespace
}  // namespace tubecut::testing
