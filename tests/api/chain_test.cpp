// Answers chain: each one's output goes unchanged into the next request.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

Json motion(double mm_min) {
  return Json{Json::Object{{"speed", Json{Json::Object{{"mm_min", Json{mm_min}}}}}}};
}

TEST(Chain, BevelTablePointsToScheduleToReplay) {
  const auto table = post("/v1/bevel-tables", example("bevel-tables/source-000-table-1.json"));
  ASSERT_FALSE(table.outcome.error);
  const Json contour{Json::Object{{"surface", Json{"inner"}},
                                  {"outer_diameter_mm", Json{70.0}},
                                  {"wall_mm", Json{5.0}},
                                  {"closed", Json{true}},
                                  {"b_sign", at(table.body, "result/b_sign")},
                                  {"points", at(table.body, "result/points")}}};
  const Json job{Json::Object{
      {"contour", contour}, {"machine", Json{"five_axis_cutter"}}, {"motion", motion(600)}}};
  const auto schedule = post("/v1/pulse-schedules", job);
  ASSERT_FALSE(schedule.outcome.error) << schedule.outcome.body.substr(0, 1000);
  EXPECT_EQ(number(schedule.body, "result/total/C"), 360'000.0);
  EXPECT_EQ(number(schedule.body, "result/report/closure/B"), 0.0);
}

TEST(Chain, ScheduleReplaysItself) {
  const auto body = example("pulse-schedules/square-cut-from-a-bare-contour.json");
  const auto schedule = post("/v1/pulse-schedules", body);
  ASSERT_FALSE(schedule.outcome.error) << schedule.outcome.body.substr(0, 1000);
  const auto replay = post("/v1/replays", with(body, "schedule", at(schedule.body, "result")));
  ASSERT_FALSE(replay.outcome.error) << replay.outcome.body.substr(0, 1000);
  const auto& invariants = *at(replay.body, "result/invariants").as<Json::Array>();
  EXPECT_GE(invariants.size(), 10u);
  for (const auto& invariant : invariants)
    EXPECT_EQ(at(invariant, "passed"), Json{true}) << text(invariant, "name");
  EXPECT_EQ(text(replay.body, "verdict/status"), "ok");
}

TEST(Chain, ADamagedScheduleIsNamed) {
  const auto body = example("pulse-schedules/square-cut-from-a-bare-contour.json");
  const auto schedule = post("/v1/pulse-schedules", body);
  auto result = at(schedule.body, "result");
  const double first = number(result, "counts/C/100");
  const auto replay =
      post("/v1/replays", with(body, "schedule", with(result, "counts/C/100", first + 40.0)));
  ASSERT_FALSE(replay.outcome.error);
  EXPECT_EQ(text(replay.body, "verdict/status"), "review");
  EXPECT_NE(replay.outcome.body.find("invariant_broken"), std::string::npos);
}

TEST(Chain, GrooveToMillPathToSchedule) {
  const auto groove = post("/v1/grooves", example("grooves/case-a-right-angle.json"));
  ASSERT_FALSE(groove.outcome.error);
  auto path_body =
      with(example("mill-paths/case-a-end-up.json"), "groove", at(groove.body, "request"));
  path_body = with(path_body, "positions", 24.0);
  const auto path = post("/v1/mill-paths", path_body);
  ASSERT_FALSE(path.outcome.error) << path.outcome.body.substr(0, 1000);
  const Json job{Json::Object{{"mill_path", at(path.body, "request")},
                              {"machine", Json{"cone_mill"}},
                              {"motion", motion(300)}}};
  const auto schedule = post("/v1/pulse-schedules", job);
  ASSERT_FALSE(schedule.outcome.error) << schedule.outcome.body.substr(0, 1000);
  EXPECT_EQ(std::abs(number(schedule.body, "result/total/C")), 360'000.0);
}

TEST(Chain, CentreLinesToPulsesInOneRequest) {
  const auto table = example("bevel-tables/k-joint-from-centre-lines.json");
  const Json job{
      Json::Object{{"cut", table}, {"machine", Json{"five_axis_cutter"}}, {"motion", motion(600)}}};
  const auto schedule = post("/v1/pulse-schedules", job);
  ASSERT_FALSE(schedule.outcome.error) << schedule.outcome.body.substr(0, 1000);
  EXPECT_GT(number(schedule.body, "result/periods"), 1000.0);
}

TEST(Chain, OffsetPairOfSource002GoesToTheCrawler) {
  const auto schedule = post("/v1/pulse-schedules",
                             example("pulse-schedules/source-002-offset-pair-on-the-crawler.json"));
  ASSERT_FALSE(schedule.outcome.error) << schedule.outcome.body.substr(0, 1000);
  EXPECT_EQ(text(schedule.body, "verdict/status"), "ok");
  EXPECT_EQ(text(schedule.body, "request/machine"), "crawler");
  EXPECT_EQ(number(schedule.body, "result/report/standoff_growth_mm"), 0.0);
}

TEST(Chain, CommonFieldsOfAnInnerRequestAreNotLost) {
  const auto outer = example("mill-paths/case-a-end-up.json");
  const Json reference{Json::Object{{"part", Json{"P-7"}}}};
  const auto path = post("/v1/mill-paths", with(outer, "groove/reference", reference));
  ASSERT_FALSE(path.outcome.error) << path.outcome.body.substr(0, 1000);
  EXPECT_EQ(text(path.body, "request/groove/reference/part"), "P-7");
  const auto pinned = post("/v1/mill-paths", with(outer, "groove/numerics", Json{46.0}));
  EXPECT_EQ(text(pinned.body, "errors/0/pointer"), "/groove/numerics");
  EXPECT_EQ(text(pinned.body, "errors/0/code"), "numerics_mismatch");
  const Json accept{Json::Object{{"max_b_deg", Json{50.0}}}};
  const auto cut = with(example("bevel-tables/k-joint-from-centre-lines.json"), "accept", accept);
  const auto judged =
      post("/v1/pulse-schedules",
           Json{Json::Object{
               {"cut", cut}, {"machine", Json{"five_axis_cutter"}}, {"motion", motion(600)}}});
  EXPECT_EQ(text(judged.body, "errors/0/pointer"), "/cut/accept");
}

// Curve 3 of a groove is the intersection curve of a tube of diameter 2 rho3 on the chord: two
// codes that share nothing.
TEST(Chain, Curve3IsTheIntersectionCurve) {
  std::mt19937_64 random(20261120);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int compared = 0;
  while (compared < 100) {
    const double chord = any(200, 600), branch = any(0.3, 0.8) * chord;
    const double wall = any(6, 0.08 * chord), width = any(0.1, 0.4) * wall;
    const double angle = any(45, 90);
    const double root = branch / 2 - wall + width;
    const double offset = any(-0.5, 0.5) * (chord / 2 - root);
    const Json groove{Json::Object{
        {"chord", Json{Json::Object{{"outer_diameter_mm", Json{chord}}, {"wall_mm", Json{10.0}}}}},
        {"branch",
         Json{Json::Object{{"outer_diameter_mm", Json{branch}}, {"wall_mm", Json{wall}}}}},
        {"root_face", Json{Json::Object{{"height_mm", Json{2.0}}, {"width_mm", Json{width}}}}},
        {"inclination_deg", Json{angle}},
        {"eccentricity_mm", Json{offset}},
        {"filler", Json{Json::Object{{"area_mm2", Json{6.0 * wall * wall}}}}},
        {"sections", Json{72.0}}}};
    const auto answer = post("/v1/grooves", groove);
    if (answer.outcome.error) continue;  // this filler area makes no groove on this joint
    const Json joint{Json::Object{
        {"target",
         Json{Json::Object{{"outer_diameter_mm", Json{2 * root}}, {"wall_mm", Json{0.5}}}}},
        {"cutters", Json{Json::Array{Json{Json::Object{{"kind", Json{"tube"}},
                                                       {"outer_diameter_mm", Json{chord}},
                                                       {"inclination_deg", Json{angle}},
                                                       {"clocking_deg", Json{0.0}},
                                                       {"offset_mm", Json{offset}}}}}}},
        {"surfaces", Json{"outer"}},
        {"sampling", Json{Json::Object{{"uniform_points", Json{72.0}}}}}}};
    const auto curve = post("/v1/intersections", joint);
    ASSERT_FALSE(curve.outcome.error) << curve.outcome.body.substr(0, 500);
    const auto z = numbers(curve.body, "result/profiles/0/points/z_mm");
    const auto phi = numbers(answer.body, "result/sections/phi_deg");
    const auto root_z = numbers(answer.body, "result/sections/root_z_mm");
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const auto at_phi = static_cast<std::size_t>(std::lround(phi[i] / 5.0) + 72) % 72;
      ASSERT_NEAR(phi[i] - 5.0 * std::lround(phi[i] / 5.0), 0.0, 1e-9);
      ASSERT_NEAR(z[at_phi], root_z[i], 1e-9) << compared << " " << i;
    }
    ++compared;
  }
}

TEST(Chain, TheMachineOfANameIsPartOfTheJob) {
  const auto asked = example("pulse-schedules/source-002-offset-pair-on-the-crawler.json");
  const auto named = post("/v1/pulse-schedules", asked);
  ASSERT_FALSE(named.outcome.error) << named.outcome.body.substr(0, 1000);
  const auto hash = text(named.body, "request/machine_sha256");
  EXPECT_EQ(hash, text(named.body, "result/machine_sha256"));
  const auto again = post("/v1/pulse-schedules", *named.body.find("request"));
  EXPECT_EQ(text(again.body, "job/input_sha256"), text(named.body, "job/input_sha256"));
  const auto refused =
      post("/v1/pulse-schedules", with(asked, "machine_sha256", Json{std::string(64, '0')}));
  EXPECT_EQ(refused.outcome.error, ErrorKind::conflict);
  EXPECT_EQ(text(refused.body, "errors/0/code"), "machine_mismatch");
  EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/machine_sha256");
  EXPECT_EQ(text(refused.body, "errors/0/limit"), hash);
  const auto limited =
      post("/v1/bevel-tables", example("bevel-tables/table-1-five-axis-at-600-mm-min.json"));
  EXPECT_EQ(text(limited.body, "request/smoothing/limits/machine_sha256").size(), 64U);
}

}  // namespace
}  // namespace tubecut::testing
