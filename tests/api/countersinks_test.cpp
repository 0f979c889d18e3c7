#include <gtest/gtest.h>

#include <cmath>

#include "tests/api/part_pulses.hpp"
#include "tests/support/call.hpp"

/// Countersinks of parts: request, answer and files.
namespace tubecut::testing {
namespace {

using api::Json;

Json of_text(const std::string& text) { return *api::parse(text); }

constexpr const char* kRoundTube = R"("outer_diameter_mm": 88.9, "wall_mm": 5)";
constexpr const char* kSquareTube =
    R"("kind": "rectangular_tube", "height_mm": 100, "width_mm": 100, "wall_mm": 5, "corners": "en_10219")";

Json sunk_part(const char* tube, const std::string& cutout) {
  return of_text(R"({"target": {)" + std::string(tube) + R"(, "length_mm": 400},
                     "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                     "kerf_mm": 1, "cutouts": [)" +
                 cutout + "]}");
}

std::string bolt(const char* place, const char* rest = "",
                 const char* sink = R"("diameter_mm": 16, "angle_deg": 90)") {
  return R"({"id": "bolt", "shape": {"kind": "circle", "diameter_mm": 9}, "at": {"z_mm": 100, )" +
         std::string(place) + R"(}, "countersink": {)" + sink + "}" + rest + "}";
}

TEST(Countersinks, AreAGroupAfterTheirCircle) {
  for (const bool round : {true, false}) {
    const auto made = post(
        "/v1/parts", sunk_part(round ? kRoundTube : kSquareTube,
                               bolt(round ? R"("phi_deg": 30)" : R"("face": 2, "offset_mm": 5)",
                                    R"(, "wall": "through")")));
    ASSERT_FALSE(made.outcome.error) << made.outcome.body.substr(0, 1500);
    ASSERT_EQ(at(made.body, "result/cutouts").as<Json::Array>()->size(), 3u);
    const auto& cone = at(made.body, "result/cutouts/1");
    EXPECT_EQ(text(cone, "wall"), "countersink");
    EXPECT_EQ(text(cone, "side"), "near");
    EXPECT_EQ(text(at(made.body, "result/cutouts/2"), "side"), "far");
    EXPECT_NEAR(number(cone, "countersink/depth_mm"), 3.5, 1e-9);
    EXPECT_NEAR(number(cone, "countersink/land_mm"), 1.5, 1e-9);
    EXPECT_NEAR(number(cone, "instances/0/z_to_mm"), 108.0, 1e-9);
    double most = 0.0;
    for (const double b : numbers(cone, "points/b_deg")) most = std::max(most, std::abs(b));
    EXPECT_NEAR(most, 45.0, 1e-9);
    EXPECT_EQ(text(made.body, "request/cutouts/0/tilt"), "free");
    // The circle's step is followed by its cone's.
    std::vector<double> order;
    for (const auto& step : *at(made.body, "result/sequence").as<Json::Array>())
      if (text(step, "what") == "cutout") order.push_back(number(step, "index"));
    const auto circle = std::ranges::find(order, 0.0);
    ASSERT_LT(circle + 1, order.end());
    EXPECT_EQ(*(circle + 1), 1.0);
    const auto again = post("/v1/parts", at(made.body, "request"));
    EXPECT_EQ(text(made.body, "job/result_sha256"), text(again.body, "job/result_sha256"));
  }
}

TEST(Countersinks, AreRefusedAtTheirFields) {
  const auto refused = [](const std::string& cutout, const char* more = "") {
    auto body = api::dump(sunk_part(kRoundTube, cutout));
    body.insert(body.size() - 1, more);
    const auto answer = post("/v1/parts", of_text(body));
    EXPECT_TRUE(answer.outcome.error) << cutout;
    EXPECT_EQ(at(answer.body, "errors").as<Json::Array>()->size(), 1u) << answer.outcome.body;
    return text(answer.body, "errors/0/code") + " " + text(answer.body, "errors/0/pointer");
  };
  const char* place = R"("phi_deg": 0)";
  EXPECT_EQ(refused(bolt(place, R"(, "wall": "developed")")),
            "unsupported_combination /cutouts/0/countersink");
  EXPECT_EQ(refused(R"({"id": "s", "shape": {"kind": "slot", "length_mm": 30, "width_mm": 8},
                        "at": {"z_mm": 100, "phi_deg": 0},
                        "countersink": {"diameter_mm": 14, "angle_deg": 90}})"),
            "unsupported_combination /cutouts/0/countersink");
  EXPECT_EQ(refused(bolt(place, R"(, "tilt": "axial")")),
            "unsupported_combination /cutouts/0/tilt");
  EXPECT_EQ(refused(bolt(place, "", R"("diameter_mm": 9, "angle_deg": 90)")),
            "out_of_range /cutouts/0/countersink/diameter_mm");
  EXPECT_EQ(refused(bolt(place, "", R"("diameter_mm": 16, "angle_deg": 20)")),
            "out_of_range /cutouts/0/countersink/angle_deg");
  EXPECT_EQ(refused(bolt(place, "", R"("diameter_mm": 16)")),
            "missing_field /cutouts/0/countersink/angle_deg");
  EXPECT_EQ(refused(bolt(place, "", R"("diameter_mm": 16, "angle_deg": 140)")),
            "open_profile /cutouts/0/countersink/angle_deg");
  EXPECT_EQ(refused(bolt(place), R"(, "torch": {"min_deg": -40, "max_deg": 60})"),
            "torch_range /cutouts/0/countersink/angle_deg");
}

TEST(Countersinks, OfAFaceStayWithinItsFlat) {
  const auto answer = post(
      "/v1/parts",
      sunk_part(kSquareTube, bolt(R"("face": 2)", "", R"("diameter_mm": 90, "angle_deg": 90)")));
  ASSERT_TRUE(answer.outcome.error);
  EXPECT_EQ(text(answer.body, "errors/0/pointer"), "/cutouts/0/countersink/diameter_mm");
}

TEST(Countersinks, AreInEveryFile) {
  for (const bool round : {true, false}) {
    const auto body = api::dump(sunk_part(round ? kRoundTube : kSquareTube,
                                          bolt(round ? R"("phi_deg": 0)" : R"("face": 1)")));
    const auto text_of = [&](const char* query) {
      const auto posted = post("/v1/parts", body, query);
      EXPECT_FALSE(posted.outcome.error) << query << posted.outcome.body.substr(0, 800);
      return posted.outcome.body;
    };
    const auto count = [](const std::string& in, const std::string& what) {
      std::size_t n = 0;
      for (auto at = in.find(what); at != std::string::npos; at = in.find(what, at + 1)) ++n;
      return n;
    };
    const auto nc1 = text_of("format=nc1");
    EXPECT_EQ(count(nc1, "\r\nBO\r\n"), 1u);
    EXPECT_EQ(count(nc1, "; countersink 16; sunk at 90;"), 1u) << nc1;
    EXPECT_EQ(count(nc1, "countersink of bolt after its bore: 16 mm"), 1u);
    const auto step = text_of("format=step");
    EXPECT_GE(count(step, "'cut-out bolt countersink'"), 2u);
    EXPECT_EQ(count(step, "'cut-out bolt'"), 0u);
    EXPECT_EQ(count(step, "CONICAL_SURFACE"), round ? 0u : 2u);
    EXPECT_GE(count(text_of("format=svg"), "sunk to 16 at 90"), 1u);
    EXPECT_GE(count(text_of("format=csv"), "cut-out bolt countersink"), 1u);
    EXPECT_GE(count(text_of("format=gcode&speed_mm_min=1200&lead_mm=2&pivot_length_mm=200"),
                    "cut-out bolt countersink"),
              1u);
  }
}

/// Where the cone's land does not go all round, no STEP is printed rather than a wrong one.
TEST(Countersinks, WithoutALandAllRoundHaveNoStep) {
  const auto body = api::dump(sunk_part(
      kRoundTube, bolt(R"("phi_deg": 0)", "", R"("diameter_mm": 19.2, "angle_deg": 90)")));
  EXPECT_FALSE(post("/v1/parts", body, "format=dxf").outcome.error);
  const auto step = post("/v1/parts", body, "format=step");
  ASSERT_TRUE(step.outcome.error);
  EXPECT_NE(step.outcome.body.find("countersink bolt"), std::string::npos);
}

TEST(Countersinks, HaveNoPulsesOfATorchThatDoesNotLeanAcross) {
  const auto answer = pulses_of(sunk_part(kRoundTube, bolt(R"("phi_deg": 0)")));
  ASSERT_TRUE(answer.outcome.error);
  EXPECT_NE(answer.outcome.body.find("/part/cutouts/0/countersink"), std::string::npos)
      << answer.outcome.body.substr(0, 600);
}

}  // namespace
}  // namespace tubecut::testing
