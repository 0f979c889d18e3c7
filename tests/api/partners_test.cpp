#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr const char* kPath = "/v1/bevel-tables";

api::Json mixed() { return example("bevel-tables/tube-on-rectangular-tube-and-reducer.json"); }
api::Json elbow() { return example("bevel-tables/tube-on-elbow.json"); }

TEST(Partners, RectangularTubeConeAndElbowAreCutAndProved) {
  for (const auto& request : {mixed(), elbow()}) {
    for (const char* path : {kPath, "/v1/intersections"}) {
      auto body = request;
      if (path != std::string_view(kPath))
        for (const char* field : {"groove", "root_surface", "kerf_mm", "smoothing"})
          body = without(body, field);
      const auto answer = post(path, body);
      ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
      EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
    }
    const auto gap = numbers(post(kPath, request).body, "result/points/gap_mm");
    EXPECT_GT(gap.size(), 30u);
  }
  const auto cutter = numbers(post(kPath, mixed()).body, "result/points/cutter");
  EXPECT_NE(std::ranges::min(cutter), std::ranges::max(cutter));  // both cut
}

std::string refusal(const api::Json& request, std::string_view pointer) {
  const auto answer = post(kPath, request);
  if (!answer.outcome.error) return "no error";
  const auto& errors = *at(answer.body, "errors").as<api::Json::Array>();
  for (const auto& one : errors)
    if (text(one, "pointer") == pointer) return text(one, "code");
  return answer.outcome.body;
}

TEST(Partners, EveryFieldIsChecked) {
  const auto box = [](std::string_view field, api::Json value) {
    return with(mixed(), "cutters/0/" + std::string(field), std::move(value));
  };
  EXPECT_EQ(refusal(box("corner_radius_mm", 0.0), "/cutters/0/corner_radius_mm"), "out_of_range");
  EXPECT_EQ(refusal(box("corner_radius_mm", 51.0), "/cutters/0/corner_radius_mm"), "out_of_range");
  EXPECT_EQ(refusal(box("width_mm", 0.4), "/cutters/0/width_mm"), "out_of_range");
  EXPECT_EQ(refusal(box("depth_mm", 4.0), "/cutters/0/depth_mm"), "unknown_field");
  EXPECT_EQ(refusal(without(mixed(), "cutters/0/up"), "/cutters/0/up"), "missing_field");
  EXPECT_EQ(refusal(box("up", at(mixed(), "cutters/0/axis/direction")), "/cutters/0/up"),
            "bad_reference_direction");
  const auto cone = [](std::string_view field, double value) {
    return with(mixed(), "cutters/1/" + std::string(field), value);
  };
  EXPECT_EQ(refusal(cone("half_angle_deg", 81.0), "/cutters/1/half_angle_deg"), "out_of_range");
  EXPECT_EQ(refusal(cone("half_angle_deg", 79.0), "/cutters/1"), "parallel_axes");
  const auto bend = [](std::string_view field, double value) {
    return with(elbow(), "cutters/0/" + std::string(field), value);
  };
  EXPECT_EQ(refusal(bend("bend_radius_mm", 57.0), "/cutters/0/bend_radius_mm"), "out_of_range");
  EXPECT_EQ(refusal(bend("bend_deg", 181.0), "/cutters/0/bend_deg"), "out_of_range");
}

// The support is set on the bend along its run, on the axis: on the back of the torus.
TEST(Partners, AnElbowCarriesALegAlongItsRun) {
  const auto request =
      *api::parse(read_project_file("tests/field/dummy-leg-on-elbow.intersection.json"));
  const auto curves = post("/v1/intersections", request);
  ASSERT_FALSE(curves.outcome.error) << curves.outcome.body.substr(0, 1500);
  EXPECT_EQ(text(curves.body, "verdict/status"), "ok");
  std::size_t seen = 0;
  for (const auto& curve : *at(curves.body, "result/profiles").as<api::Json::Array>()) {
    const auto phi = numbers(curve, "points/phi_deg"), z = numbers(curve, "points/z_mm");
    for (std::size_t i = 0; i < phi.size(); ++i, ++seen) {
      const double turn = phi[i] * std::acos(-1.0) / 180.0, rho = number(curve, "radius_mm");
      const double x = rho * std::cos(turn), y = rho * std::sin(turn);
      const double reach = 228.6 + std::sqrt(84.15 * 84.15 - y * y);
      EXPECT_NEAR(z[i], std::sqrt(reach * reach - (x - 228.6) * (x - 228.6)), 1e-9);
    }
  }
  EXPECT_GE(seen, 720U);
  const auto leg =
      with(with(elbow(), "target", at(request, "target")), "cutters", at(request, "cutters"));
  const auto table = post(kPath, with(leg, "smoothing", *api::parse(R"({"method": "none"})")));
  ASSERT_FALSE(table.outcome.error) << table.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(table.body, "verification/passed"), api::Json{true});
}

TEST(Partners, ARefusalForParallelAxesHasAnAction) {
  const auto up = [](const char* z) { return *api::parse(std::string("[0, 0, ") + z + "]"); };
  const auto leg =
      *api::parse(read_project_file("tests/field/dummy-leg-on-elbow.intersection.json"));
  const auto along = [](const api::Json& request, const char* cutter, api::Json direction) {
    return with(request, std::string("cutters/") + cutter + "/axis/direction",
                std::move(direction));
  };
  const auto box = with(along(mixed(), "0", up("1")), "cutters/0/up", *api::parse("[1, 0, 0]"));
  struct {
    const char* path;
    api::Json request;
  } const cases[] = {{"/v1/intersections", along(leg, "0", up("-1"))},
                     {kPath, box},
                     {kPath, along(mixed(), "1", up("1"))},
                     {kPath, with(mixed(), "cutters/1/half_angle_deg", 79.0)}};
  for (const auto& [path, request] : cases) {
    const auto answer = post(path, request);
    ASSERT_TRUE(answer.outcome.error) << path;
    EXPECT_EQ(text(answer.body, "code"), "parallel_axes") << answer.outcome.body;
    for (const auto& one : *at(answer.body, "errors").as<api::Json::Array>())
      EXPECT_FALSE(text(one, "hint").empty()) << answer.outcome.body;
  }
}

}  // namespace
}  // namespace tubecut::testing
