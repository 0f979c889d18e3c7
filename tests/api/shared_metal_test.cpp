#include <gtest/gtest.h>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

Json field(std::string_view file) {
  return *api::parse(read_project_file("tests/field/" + std::string(file)));
}

/// Number of warnings that members share metal.
std::size_t told(const Posted& answer) {
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  std::size_t out = 0;
  for (const auto& one : *at(answer.body, "warnings").as<Json::Array>())
    out += text(one, "code") == "members_overlap" ? 1U : 0U;
  return out;
}

TEST(SharedMetal, ThinWallsThatRunIntoEachOther) {
  for (const char* file : {"parallel-tubes-overlap.frame.json", "bar-through-tube.frame.json"}) {
    const auto frame = field(file);
    const auto answer = post("/v1/frames", frame);
    EXPECT_EQ(told(answer), 1U) << file;
    EXPECT_EQ(text(answer.body, "verdict/status"), "review");
    const Json node{Json::Object{{"members", at(frame, "members")},
                                 {"connect", Json{Json::Object{{"within_mm", 20.0}}}}}};
    EXPECT_EQ(told(post("/v1/nodes", node)), 1U) << file;
  }
}

Json point(double x, double y, double z) { return Json{Json::Array{x, y, z}}; }

/// A tube along x that a plate across it cuts at x = 400, and one that crosses its axis at `x`.
Json cut_by_a_plate(double x) {
  const auto member = [](const char* id, Json start, Json end) {
    return Json{Json::Object{{"id", id},
                             {"start_mm", std::move(start)},
                             {"end_mm", std::move(end)},
                             {"outer_diameter_mm", 42.4},
                             {"wall_mm", 2.0}}};
  };
  auto out = field("parallel-tubes-overlap.frame.json");
  out = with(out, "members",
             Json{Json::Array{member("a", point(0, 0, 0), point(500, 0, 0)),
                              member("b", point(x, 0, -300), point(x, 0, 300))}});
  out = with(out, "others",
             Json{Json::Array{Json{Json::Object{{"id", "plate"},
                                                {"kind", "plane"},
                                                {"point_mm", point(400, 0, 0)},
                                                {"normal", point(1, 0, 0)}}}}});
  return with(
      out, "joints",
      Json{Json::Array{Json{Json::Object{
          {"between", Json{Json::Array{"a", "plate"}}}, {"kind", "set_on"}, {"end", "finish"}}}}});
}

// Metal that another member cuts off does not count.
TEST(SharedMetal, EndsAreWhereTheOthersCutThem) {
  EXPECT_EQ(told(post("/v1/frames", cut_by_a_plate(450))), 0U);
  EXPECT_EQ(told(post("/v1/frames", cut_by_a_plate(421.5))), 0U);
  EXPECT_EQ(told(post("/v1/frames", cut_by_a_plate(420.5))), 1U);
  EXPECT_EQ(told(post("/v1/frames", cut_by_a_plate(200))), 1U);
}

}  // namespace
}  // namespace tubecut::testing
