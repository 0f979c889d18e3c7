#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr const char* kCurves = "/v1/intersections";

api::Json k_joint() { return example("intersections/shs-k-joint.json"); }

/// The example with its section stated.
api::Json stated(api::Json target) { return with(k_joint(), "target", std::move(target)); }

api::Json rectangle(double height, double width, double wall) {
  api::Json out = api::Json::Object{};
  out = with(out, "kind", "rectangular_tube");
  out = with(out, "height_mm", height);
  out = with(out, "width_mm", width);
  return with(out, "wall_mm", wall);
}

std::string refusal(const api::Json& request, std::string_view pointer,
                    std::string_view path = kCurves) {
  const auto answer = post(path, request);
  if (!answer.outcome.error) return "no error";
  for (const auto& one : *at(answer.body, "errors").as<api::Json::Array>())
    if (text(one, "pointer") == pointer) return text(one, "code");
  return answer.outcome.body;
}

TEST(Sections, KJointIsGoldenAndProved) {
  const auto answer = post(kCurves, k_joint());
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  EXPECT_EQ(text(answer.body, "request/target/kind"), "rectangular_tube");
  EXPECT_EQ(text(answer.body, "result/section/corners"), "nominal");
  EXPECT_EQ(number(answer.body, "result/section/corner_radius_mm"), 8.0);
  // sections.json, shs_two_tubes
  EXPECT_NEAR(number(answer.body, "result/section/area_mm2"), 1174.7964473723, 1e-9);
  const auto& outer = at(answer.body, "result/profiles/1");
  EXPECT_EQ(text(outer, "surface"), "outer");
  EXPECT_NEAR(number(outer, "developed_length_mm"), 306.26548245744, 1e-9);
  std::vector<double> junctions;
  int seams = 0;
  for (const auto& event : *at(outer, "events").as<api::Json::Array>()) {
    if (text(event, "kind") == "junction") junctions.push_back(number(event, "girth_mm"));
    seams += text(event, "kind") == "tangent_line" ? 1 : 0;
  }
  EXPECT_EQ(seams, 8);
  ASSERT_EQ(junctions.size(), 2U);
  EXPECT_NEAR(junctions[0], 91.941003898726, 1e-9);
  EXPECT_NEAR(junctions[1], 240.93400491545, 1e-9);
  // A row on a corner names the face before it.
  const auto girth = numbers(outer, "points/girth_mm"),
             normal = numbers(outer, "points/normal_deg"), face = numbers(outer, "points/face");
  const auto& corner = *at(outer, "points/on_corner").as<api::Json::Array>();
  ASSERT_EQ(corner.size(), girth.size());
  for (std::size_t i = 0; i < girth.size(); ++i) {
    if (corner[i] != api::Json{true}) {
      EXPECT_EQ(std::fmod(normal[i], 90.0), 0.0);
      EXPECT_EQ(std::fmod(normal[i] / 90.0, 4.0) + 1.0, face[i]);
    } else {
      EXPECT_EQ(std::floor(normal[i] / 90.0 + 1e-12) + 1.0, face[i]);
    }
  }
}

TEST(Sections, NameStandardAndStatedRadiiGiveOneSection) {
  auto by_name = k_joint();
  const auto by_standard = stated(with(rectangle(80, 80, 4), "corners", "en_10219"));
  const auto by_radius = stated(with(rectangle(80, 80, 4), "corner_radius_mm", 8.0));
  const auto result = [](const api::Json& request) {
    auto answer = post(kCurves, request);
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    return without(at(answer.body, "result"), "section/corners");
  };
  EXPECT_EQ(result(by_name), result(by_standard));
  EXPECT_EQ(result(by_name), result(by_radius));
}

/// Corners of half the side: the numbers of the round tube.
TEST(Sections, OvalOfEqualSidesIsTheRoundTube) {
  auto round = with(k_joint(), "sampling/uniform_points", 90.0);
  round = with(round, "target", api::Json{api::Json::Object{}});
  round = with(round, "target/outer_diameter_mm", 80.0);
  round = with(round, "target/wall_mm", 4.0);
  auto oval = with(round, "target", with(rectangle(80, 80, 4), "kind", "flat_oval_tube"));
  const auto a = post(kCurves, round), b = post(kCurves, oval);
  ASSERT_FALSE(a.outcome.error);
  ASSERT_FALSE(b.outcome.error) << b.outcome.body.substr(0, 900);
  for (const char* profile : {"result/profiles/0/", "result/profiles/1/"}) {
    const auto path = [&](const char* name) { return std::string(profile) + name; };
    const auto za = numbers(a.body, path("points/z_mm")), zb = numbers(b.body, path("points/z_mm"));
    const auto phi = numbers(a.body, path("points/phi_deg")),
               nu = numbers(b.body, path("points/normal_deg"));
    ASSERT_EQ(za.size(), zb.size());
    for (std::size_t i = 0; i < za.size(); ++i) {
      EXPECT_NEAR(za[i], zb[i], 1e-9);
      EXPECT_NEAR(phi[i], nu[i], 1e-9);
    }
    EXPECT_NEAR(number(a.body, path("length_mm")), number(b.body, path("length_mm")), 1e-6);
  }
}

TEST(Sections, EveryFieldIsChecked) {
  const auto standard = [](api::Json target) { return with(target, "corners", "en_10210"); };
  EXPECT_EQ(refusal(stated(rectangle(100, 50, 4)), "/target/corners"), "missing_field");
  EXPECT_EQ(refusal(stated(with(rectangle(100, 50, 4), "corners", "en_1")), "/target/corners"),
            "bad_choice");
  EXPECT_EQ(refusal(stated(standard(rectangle(4, 50, 4))), "/target/height_mm"), "out_of_range");
  EXPECT_EQ(refusal(stated(standard(rectangle(100, 50, 25))), "/target/wall_mm"), "out_of_range");
  EXPECT_EQ(refusal(stated(with(rectangle(100, 50, 4), "corner_radius_mm", 4.1)),
                    "/target/corner_radius_mm"),
            "out_of_range");
  EXPECT_EQ(refusal(stated(with(rectangle(100, 50, 4), "corner_radius_mm", 26.0)),
                    "/target/corner_radius_mm"),
            "out_of_range");
  EXPECT_EQ(refusal(stated(with(standard(rectangle(100, 50, 4)), "inner_corner_radius_mm", 4.0)),
                    "/target/inner_corner_radius_mm"),
            "exclusive_fields");
  EXPECT_EQ(refusal(with(k_joint(), "target/wall_mm", 4.0), "/target/wall_mm"), "exclusive_fields");
  EXPECT_EQ(refusal(stated(standard(with(rectangle(100, 50, 4), "outer_diameter_mm", 60.0))),
                    "/target/outer_diameter_mm"),
            "unknown_field");
  EXPECT_EQ(refusal(with(with(k_joint(), "target/kind", "rectangular_tube"), "target/size",
                         "RHS 100x50x4"),
                    "/target/size"),
            "unknown_size");
}

TEST(Sections, AnUnknownSizeNamesThoseThatAreMeant) {
  const auto hint = [](const char* size) {
    return text(post("/v1/bevel-tables",
                     with(with(k_joint(), "target/kind", "rectangular_tube"), "target/size", size))
                    .body,
                "errors/0/hint");
  };
  EXPECT_EQ(hint("RHS 100x50x4"),
            "did you mean one of RHS 100x50x4 EN 10210, RHS 100x50x4 EN 10219?");
  EXPECT_EQ(hint("SHS 40x3"), "did you mean one of SHS 40x40x3 EN 10210, SHS 40x40x3 EN 10219?");
  EXPECT_EQ(hint("shs 40x3 EN 10219"), "did you mean SHS 40x40x3 EN 10219?");
}

/// What cannot be cut yet is refused by name, and the hint names who can.
TEST(Sections, OtherEndpointsNameWhoCutsThem) {
  const auto answer = post("/v1/holes", with(without(example("holes/set-on-branch.json"), "chord"),
                                             "chord/size", "SHS 80x80x4 EN 10219"));
  ASSERT_TRUE(answer.outcome.error);
  bool named = false;
  for (const auto& one : *at(answer.body, "errors").as<api::Json::Array>())
    named = named || (text(one, "code") == "unsupported_target" &&
                      text(one, "hint").find("/v1/intersections") != std::string::npos);
  EXPECT_TRUE(named) << answer.outcome.body;
}

TEST(Sections, CsvHasThePlacesAndAViewOfRoundWallsIsRefused) {
  const auto body = api::dump(k_joint());
  const auto csv = post(kCurves, std::string_view(body), "format=csv");
  ASSERT_FALSE(csv.outcome.error) << csv.outcome.body.substr(0, 500);
  EXPECT_NE(csv.outcome.body.find("surface,girth_mm,normal_deg,face,on_corner"), std::string::npos);
  for (const char* query : {"format=svg", "format=svg&view=template", "format=pdf", "format=dxf"})
    EXPECT_FALSE(post(kCurves, std::string_view(body), query).outcome.error) << query;
  const auto wall = post(kCurves, std::string_view(body), "format=svg&view=section");
  ASSERT_TRUE(wall.outcome.error);
  EXPECT_NE(wall.outcome.body.find("template"), std::string::npos);
}

TEST(Sections, SizesAreListedAsideFromRoundOnes) {
  const api::Call call{.method = "GET",
                       .path = "/v1/tubes",
                       .query = {},
                       .accept = {},
                       .content_type = {},
                       .body = {},
                       .job_id = {},
                       .request_id = "test"};
  const auto page = api::parse(api::dispatch(call, {}).body);
  ASSERT_TRUE(page);
  const auto& sizes = *at(*page, "rectangular_tubes").as<api::Json::Array>();
  EXPECT_GT(sizes.size(), 200U);
  for (const auto& size : sizes) {
    const auto answer = post(kCurves, with(k_joint(), "target/size", text(size, "size")));
    // Some are wider than the chord; each is a section that can be cut.
    const bool open = answer.outcome.body.find("open_profile") != std::string::npos;
    EXPECT_TRUE(!answer.outcome.error || open) << answer.outcome.body.substr(0, 400);
  }
  for (const auto& size : *at(*page, "tubes").as<api::Json::Array>())
    EXPECT_GT(number(size, "outer_diameter_mm"), 0.0);
}

}  // namespace
}  // namespace tubecut::testing
