#include "api/verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

TEST(Verdict, LongLinesContinueAndNeverBeginWithAClientsWord) {
  api::Verdict verdict{.status = "review", .reasons = {"free_end"}};
  verdict.warnings.push_back("free_end at /members/0/start_mm: " + std::string(300, 'x') +
                             " LOGOPEN,/tmp/x meets no member here");
  for (const std::size_t width : {40U, 76U, 100U}) {
    std::string whole;
    for (const auto& line : api::verdict_lines(verdict, {.width = width})) {
      EXPECT_LE(line.size(), width);
      EXPECT_FALSE(line.starts_with("LOGOPEN"));
      whole += line.starts_with("... ") ? line.substr(4) : line;
    }
    whole.erase(std::remove(whole.begin(), whole.end(), ' '), whole.end());
    EXPECT_NE(whole.find(std::string(300, 'x').append("LOGOPEN,/tmp/xmeetsnomember")),
              std::string::npos);
  }
}

TEST(Verdict, WarningsWithoutRoomAreCounted) {
  api::Verdict verdict{.status = "review", .reasons = {"slow_zone"}};
  for (int i = 0; i < 9; ++i) verdict.warnings.push_back("slow_zone: " + std::to_string(i));
  const auto lines = api::verdict_lines(verdict, {.warnings = 4});
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[5], "warning: slow_zone: 3");
  EXPECT_TRUE(lines[6].starts_with("and 5 more warnings"));
}

TEST(Verdict, TheHeaderNamesEachReasonOnce) {
  const api::Verdict verdict{.status = "reject", .reasons = {"a", "b", "a", "max_b_deg: 2 > 1"}};
  EXPECT_EQ(api::verdict_header(verdict), "reject;reasons=\"a, b, max_b_deg: 2 > 1\"");
  EXPECT_EQ(api::verdict_header({}), "ok");
}

TEST(Verdict, ReasonsAreASet) {
  const std::vector<Warning> warnings{{.code = WarningCode::free_end, .member = "members/0"},
                                      {.code = WarningCode::free_end, .member = "members/1"},
                                      {.code = WarningCode::members_overlap, .member = "members/0"},
                                      {.code = WarningCode::near_parallel, .member = "members/0"},
                                      {.code = WarningCode::free_end, .member = "members/2"}};
  const auto verdict = api::judge(warnings, Json{}, {{"max_b_deg", 83.0}}, {{"max_b_deg", 80.0}});
  EXPECT_EQ(verdict.reasons,
            (std::vector<std::string>{"free_end", "members_overlap", "max_b_deg: 83 > 80"}));
  EXPECT_EQ(verdict.warnings.size(), 4U) << "each is told";
}

// A cut that follows a member beyond its end is for review by every way to request it.
TEST(Verdict, EveryEndpointReportsAGhost) {
  const auto member = *api::parse(R"([
    {"id": "stub", "start_mm": [0, 0, 0], "end_mm": [5, 0, 0], "outer_diameter_mm": 120, "wall_mm": 5},
    {"id": "B", "start_mm": [0, 0, 0], "end_mm": [600, 0, 600], "outer_diameter_mm": 60, "wall_mm": 4}])");
  const auto connect = *api::parse(R"([{"member": "B", "end": "start", "to": ["stub"]}])");
  const Json node{
      Json::Object{{"members", member}, {"connect", connect}, {"member", "B"}, {"end", "start"}}};
  const auto options = *api::parse(R"({"root_surface": "inner", "groove": {"rule": "none"},
    "kerf_mm": 1, "smoothing": {"method": "none"}})");
  auto table = with(options, "node", node);
  auto part = with(with(with(options, "members", member), "connect", connect), "member", "B");
  part = with(part, "up", *api::parse("[0, 1, 0]"));
  const Json schedule{Json::Object{{"cut", table},
                                   {"machine", "five_axis_cutter"},
                                   {"motion", *api::parse(R"({"speed": {"mm_min": 600}})")}}};
  const std::pair<const char*, Json> ways[] = {
      {"/v1/nodes", Json{Json::Object{{"members", member}, {"connect", connect}}}},
      {"/v1/intersections", Json{Json::Object{{"node", node}}}},
      {"/v1/bevel-tables", table},
      {"/v1/parts", part},
      {"/v1/pulse-schedules", schedule}};
  for (const auto& [path, request] : ways) {
    const auto answer = post(path, request);
    ASSERT_FALSE(answer.outcome.error) << path << answer.outcome.body.substr(0, 600);
    EXPECT_NE(text(answer.body, "verdict/status"), "ok") << path;
    bool named = false;
    for (const auto& w : *at(answer.body, "warnings").as<Json::Array>())
      named = named || (text(w, "code") == "ghost_contact" &&
                        text(w, "pointer").ends_with("members/1/start_mm"));
    EXPECT_TRUE(named) << path << api::dump(at(answer.body, "warnings"));
  }
}

/// 9.2 less 4.2 is 4.999999999999999: a value that equals its limit but for rounding meets it.
TEST(Verdict, RoundingIsNoReasonToReject) {
  const double value = 9.2 - 4.2;
  ASSERT_LT(value, 5.0);
  EXPECT_EQ(api::judge({}, Json{}, {{"min_web_mm", value}}, {{"min_web_mm", 5.0}}).status, "ok");
  EXPECT_EQ(api::judge({}, Json{}, {{"min_web_mm", 4.99999}}, {{"min_web_mm", 5.0}}).status,
            "reject");
  EXPECT_EQ(
      api::judge({}, Json{}, {{"max_root_gap_mm", 3.0 + 1e-15}}, {{"max_root_gap_mm", 3.0}}).status,
      "ok");
  EXPECT_EQ(
      api::judge({}, Json{}, {{"max_root_gap_mm", 3.00001}}, {{"max_root_gap_mm", 3.0}}).status,
      "reject");
}

}  // namespace
}  // namespace tubecut::testing
