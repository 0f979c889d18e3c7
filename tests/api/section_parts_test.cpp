#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/call.hpp"

/// Parts of tubes that are not round, as /v1/parts answers and refuses them.
namespace tubecut::testing::section_parts {

constexpr const char* kParts = "/v1/parts";

api::Json rail() { return example("parts/gate-rail-of-60x40-mitred.json"); }

api::Json parsed(const char* text) { return *api::parse(text); }

/// The rail with a bevel and all fields stated.
api::Json bevelled() {
  auto out = without(rail(), "preset");
  const auto cut = parsed(
      R"({"cutters": [{"kind": "tube", "outer_diameter_mm": 114.3, "inclination_deg": 70}],
          "root_surface": "inner", "groove": {"rule": "half_dihedral"},
          "smoothing": {"method": "none"}})");
  return with(out, "ends", with(with(parsed("{}"), "start", cut), "finish", cut));
}

TEST(SectionPartRequests, MitreIsMeasuredOnEachFace) {
  const auto answer = post(kParts, rail());
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  const auto lengths = numbers(answer.body, "result/side_lengths/face_mm");
  // The finish stops 30 mm before its work point; the mitre's plane falls by 60 mm over the height.
  const double wanted[] = {1200.0 - 30.0 + 30.0 - 3.0, 1170.0, 1140.0, 1170.0};
  for (std::size_t face = 0; face < 4; ++face) EXPECT_NEAR(lengths[face], wanted[face], 0.05);
  const auto& faces = *at(answer.body, "result/ends/start/faces").as<api::Json::Array>();
  const double angles[] = {0.0, 45.0, 0.0, -45.0}, tilts[] = {45.0, 0.0, -45.0, 0.0};
  for (std::size_t face = 0; face < 4; ++face) {
    EXPECT_NEAR(std::abs(number(faces[face], "angle_deg")), std::abs(angles[face]), 1e-6);
    EXPECT_NEAR(number(faces[face], "saw_tilt_deg"), tilts[face], 1e-9);
  }
}

TEST(SectionPartRequests, EveryProblemIsAtItsField) {
  expect_refused(kParts, with(rail(), "target/length_mm", api::Json{60.0}), "/target/length_mm",
                 "member_consumed");
  expect_refused(kParts, with(rail(), "target/size", "RHS 61x40x3"), "/target/size",
                 "unknown_size");
  expect_refused(kParts, with(rail(), "datum", "seam"), "/datum", "bad_choice");
  for (const char* field : {"holes", "cutouts"})
    expect_refused(kParts, with(rail(), field, parsed("[]")), std::string("/") + field,
                   "unsupported_combination");
  for (const char* limit : {"min_tongue_mm", "min_web_mm", "min_hole_to_end_mm"})
    expect_refused(kParts, with(rail(), "accept", with(parsed("{}"), limit, 3.0)),
                   std::string("/accept/") + limit, "unsupported_combination");
  expect_refused(kParts,
                 with(bevelled(), "ends/finish/smoothing",
                      parsed(R"({"method": "hermite", "transition_points": 15})")),
                 "/ends/finish/smoothing/method", "unsupported_combination");
  // A machine's program needs a cross axis, which no endpoint plans yet.
  const auto schedule = example("pulse-schedules/two-ends-and-four-holes-of-a-part.json");
  const auto answer = post("/v1/pulse-schedules", with(schedule, "part", bevelled()));
  ASSERT_TRUE(answer.outcome.error);
}

/// The girth of 60 x 40 with corners of 6 is 189.70 mm.
TEST(SectionPartRequests, MarksLieWhereTheyAreStated) {
  const auto marked = [](double girth) {
    auto mark = parsed(R"({"text": "latch", "girth_mm": 0, "z_mm": 400})");
    mark = with(mark, "girth_mm", girth);
    return with(rail(), "marks", api::Json{api::Json::Array{mark}});
  };
  const auto answer = post(kParts, marked(47.5));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  const auto& mark = at(answer.body, "result/marks").as<api::Json::Array>()->back();
  EXPECT_EQ(text(mark, "text"), "latch");
  EXPECT_NEAR(number(mark, "girth_mm"), 47.5, 1e-9);
  const double start = numbers(answer.body, "result/frame/origin_mm")[2];
  EXPECT_NEAR(number(mark, "z_from_mm"), 400.0 - start, 1e-9);
  expect_refused(kParts, marked(189.7), "/marks/0/girth_mm", "out_of_range");
}

TEST(SectionPartRequests, LimitsAreHeldToBothEnds) {
  const auto gap = with(parsed("{}"), "max_gap_mm", 0.5);
  const auto answer = post(kParts, with(rail(), "accept", gap));
  ASSERT_FALSE(answer.outcome.error);
  EXPECT_EQ(text(answer.body, "verdict/status"), "reject");
  const auto reach = with(parsed("{}"), "max_reach_mm", 61.0);
  EXPECT_EQ(text(post(kParts, with(rail(), "accept", reach)).body, "verdict/status"), "ok");
}

}  // namespace tubecut::testing::section_parts
