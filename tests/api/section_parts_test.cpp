#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/angle.hpp"
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
  const double angles[] = {0.0, 45.0, 0.0, -45.0};
  for (std::size_t face = 0; face < 4; ++face)
    EXPECT_NEAR(std::abs(number(faces[face], "angle_deg")), std::abs(angles[face]), 1e-6);
}

TEST(SectionPartRequests, EveryProblemIsAtItsField) {
  expect_refused(kParts, with(rail(), "target/length_mm", api::Json{60.0}), "/target/length_mm",
                 "member_consumed");
  expect_refused(kParts, with(rail(), "target/size", "RHS 61x40x3"), "/target/size",
                 "unknown_size");
  expect_refused(kParts, with(rail(), "datum", "seam"), "/datum", "bad_choice");
  expect_refused(kParts, with(rail(), "holes", parsed("[{}]")), "/holes/0/branch", "missing_field");
  for (const char* limit : {"min_tongue_mm", "min_web_mm", "min_hole_to_end_mm"})
    expect_refused(kParts, with(rail(), "accept", with(parsed("{}"), limit, 3.0)),
                   std::string("/accept/") + limit, "unsupported_combination");
  expect_refused(kParts,
                 with(bevelled(), "ends/finish/smoothing",
                      parsed(R"({"method": "hermite", "transition_points": 15})")),
                 "/ends/finish/smoothing/method", "unsupported_combination");
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
  const auto within = post(kParts, with(rail(), "accept", reach));
  EXPECT_EQ(api::dump(at(within.body, "verdict/reasons")), R"(["root_opens"])");
}

api::Json with_cutout(const char* text) {
  return with(rail(), "cutouts", api::Json{api::Json::Array{parsed(text)}});
}

/// Between square ends, the volume is the area of the ring times the length, however few rows there
/// are.
TEST(SectionPartRequests, FewRowsHoldTheVolume) {
  for (const char* size : {"SHS 80x80x4 EN 10219", "RHS 100x50x5 EN 10210", "RHS 60x40x3 EN 10219",
                           "RHS 200x100x6 EN 10219"})
    for (int rows = 8; rows <= 20; ++rows) {
      const auto body =
          R"({"target": {"size": ")" + std::string(size) +
          R"(", "length_mm": 400}, "kerf_mm": 0.5, "ends": {"start": {"square_at_mm": 0},
             "finish": {"square_at_mm": 0}}, "sampling": {"uniform_points": )" +
          std::to_string(rows) + "}}";
      const auto answer = post(kParts, std::string_view(body));
      ASSERT_FALSE(answer.outcome.error) << size << rows << answer.outcome.body.substr(0, 300);
      const auto& section = at(answer.body, "result/section");
      EXPECT_NEAR(number(answer.body, "result/lengths/volume_mm3"),
                  400.0 * number(section, "area_mm2"), 1e-6);
    }
}

TEST(SectionPartCutouts, LieOnTheFaceThatTheRequestStates) {
  const auto answer =
      post(kParts, with_cutout(R"({"id": "bolt", "shape": {"kind": "circle", "diameter_mm": 11},
                              "at": {"z_mm": 80, "face": 2, "offset_mm": 6}, "wall": "through"})"));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  const auto& groups = *at(answer.body, "result/cutouts").as<api::Json::Array>();
  ASSERT_EQ(groups.size(), 2u);
  const double start = numbers(answer.body, "result/frame/origin_mm")[2];
  const double faces[] = {2.0, 4.0}, offsets[] = {6.0, -6.0};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(number(groups[i], "instances/0/face"), faces[i]);
    EXPECT_EQ(number(groups[i], "instances/0/offset_mm"), offsets[i]);
    EXPECT_NEAR(number(groups[i], "instances/0/z_mm"), 80.0 - start, 1e-9);
    EXPECT_NEAR(number(groups[i], "area_outer_mm2"), 0.25 * kPi * 121.0, 1e-9);
    EXPECT_NEAR(number(groups[i], "volume_mm3"), 0.25 * kPi * 121.0 * 3.0, 1e-9);
  }
  const auto plain = post(kParts, rail());
  EXPECT_NEAR(number(plain.body, "result/lengths/volume_mm3") -
                  number(answer.body, "result/lengths/volume_mm3"),
              2.0 * 0.25 * kPi * 121.0 * 3.0, 1e-6);
}

TEST(SectionPartCutouts, EveryProblemIsAtItsField) {
  const auto expect = [](const char* at, const char* more, const char* pointer, const char* code) {
    const auto text = std::string(R"({"id": "a", "shape": {"kind": "circle", "diameter_mm": 11},
                                      "at": )") +
                      at + more + "}";
    expect_refused(kParts, with_cutout(text.c_str()), pointer, code);
  };
  const char* kFace = R"({"z_mm": 300, "face": 1})";
  expect(R"({"z_mm": 300, "phi_deg": 0})", "", "/cutouts/0/at/phi_deg", "unsupported_combination");
  expect(R"({"z_mm": 300, "face": 5})", "", "/cutouts/0/at/face", "out_of_range");
  expect(R"({"z_mm": 300, "face": 1, "offset_mm": 40})", "", "/cutouts/0/at/offset_mm",
         "out_of_range");
  // A slit does not go over a corner.
  const auto slit = [&](const std::string& at, const char* pointer) {
    const auto text = R"({"id": "a", "shape": {"kind": "slit", "length_mm": 11, "angle_deg": 90},
                          "at": {"z_mm": 300, )" +
                      at + "}}";
    expect_refused(kParts, with_cutout(text.c_str()), pointer, "out_of_range");
  };
  slit(R"("face": 1, "offset_mm": 10)", "/cutouts/0/at/offset_mm");
  slit(R"("girth_mm": 16)", "/cutouts/0/at/girth_mm");
  expect(R"({"z_mm": 300, "girth_mm": 0, "offset_mm": 1})", "", "/cutouts/0/at/offset_mm",
         "unsupported_combination");
  expect(R"({"z_mm": -30, "face": 1})", "", "/cutouts/0/at/z_mm", "cutout_off_part");
  expect(kFace, R"(, "pattern": {"kind": "round", "count": 4})", "/cutouts/0/pattern/kind",
         "unsupported_combination");
  expect(kFace, R"(, "pattern": {"kind": "linear", "count": 4, "pitch_deg": 3})",
         "/cutouts/0/pattern/pitch_deg", "unsupported_combination");
  expect(kFace, R"(, "pattern": {"kind": "linear", "count": 4, "pitch_mm": 9})",
         "/cutouts/0/pattern", "cutouts_cross");
  expect(kFace, R"(, "pattern": {"kind": "faces", "faces": [1, 1]})", "/cutouts/0/pattern/faces",
         "bad_choice");
  expect(kFace, R"(, "pattern": {"kind": "faces", "faces": [2, 3]})", "/cutouts/0/pattern/faces",
         "unsupported_combination");
  expect_refused("/v1/parts", with(rail(), "accept", with(parsed("{}"), "min_diameter_mm", 3.0)),
                 "/accept/min_diameter_mm", "unsupported_combination");
  // A round tube has no faces.
  auto round = example("parts/base-post.json");
  round = with(
      round, "cutouts",
      api::Json{api::Json::Array{parsed(
          R"({"id": "a", "shape": {"kind": "circle", "diameter_mm": 11}, "at": {"z_mm": 300, "phi_deg": 0},
          "pattern": {"kind": "faces", "faces": [1]}})")}});
  expect_refused(kParts, round, "/cutouts/0/pattern/kind", "unsupported_combination");
}

/// Quarters of the girth come back after four steps, unless they go along the tube too.
TEST(SectionPartCutouts, APatternWrapsAfterWholeTurns) {
  const double girth = 2.0 * (60.0 + 40.0) - 8.0 * 6.0 + 12.0 * kPi;
  const auto posted = [&](const char* pattern, const char* each, int count) {
    auto row = with(parsed(pattern), std::string(each) + "count", api::Json{count * 1.0});
    row = with(std::move(row), std::string(each) + "pitch_round_mm", api::Json{0.25 * girth});
    auto hole = parsed(R"({"id": "a", "shape": {"kind": "circle", "diameter_mm": 5},
                           "at": {"z_mm": 300, "face": 1}})");
    return post(kParts, with(rail(), "cutouts",
                             api::Json{api::Json::Array{with(hole, "pattern", std::move(row))}}));
  };
  for (const auto& [pattern, each] :
       {std::pair{R"({"kind": "linear"})", ""},
        std::pair{R"({"kind": "faces", "faces": [1], "each": {"kind": "linear"}})", "each/"}}) {
    const auto refused = posted(pattern, each, 9);
    ASSERT_TRUE(refused.outcome.error);
    EXPECT_EQ(text(refused.body, "errors/0/code"), "pattern_wraps");
    EXPECT_EQ(text(refused.body, "errors/0/pointer"),
              "/cutouts/0/pattern/" + std::string(each) + "count");
    EXPECT_EQ(number(refused.body, "errors/0/limit"), 4.0);
    const auto most = posted(pattern, each, 4);
    EXPECT_FALSE(most.outcome.error) << most.outcome.body.substr(0, 800);
  }
  const auto helix = posted(R"({"kind": "linear", "pitch_mm": 40})", "", 9);
  EXPECT_FALSE(helix.outcome.error) << helix.outcome.body.substr(0, 800);
}

/// A step to either side that leaves the flat is told alike: at the pattern, by the flat that it
/// leaves or does not reach.
TEST(SectionPartCutouts, APatternThatLeavesItsFlatIsToldAlikeToBothSides) {
  const auto refusal = [](double pitch) {
    const auto answer = post(kParts, with(parsed(R"({"target": {"kind": "flat_oval_tube",
        "height_mm": 30, "width_mm": 60, "wall_mm": 2, "length_mm": 400}, "kerf_mm": 1,
        "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
        "cutouts": [{"id": "s", "shape": {"kind": "slit", "length_mm": 20}, "at": {"z_mm": 200,
        "face": 1}, "pattern": {"kind": "linear", "count": 2}}]})"),
                                          "cutouts/0/pattern/pitch_round_mm", api::Json{pitch}));
    EXPECT_EQ(text(answer.body, "errors/0/pointer"), "/cutouts/0/pattern") << pitch;
    EXPECT_EQ(text(answer.body, "errors/0/got"), "s.1") << pitch;
    return text(answer.body, "errors/0/hint");
  };
  for (const double pitch : {15.0, 20.0, 38.0, 40.0, 60.0}) {
    auto back = refusal(-pitch);
    if (const auto face = back.find("face 4"); face != std::string::npos) back[face + 5] = '2';
    EXPECT_EQ(refusal(pitch), back);
  }
  EXPECT_NE(refusal(-20.0).find("5.5 mm beyond the flat of face 1"), std::string::npos);
}

/// The default radius is the least that the kerf allows where the rectangle lies: half the kerf on
/// a flat, more over a corner, and a little less is refused.
TEST(SectionPartCutouts, ARectanglesDefaultRadiusIsTheLeastOfItsPlace) {
  for (const char* wall : {"normal", "developed"})
    for (const double girth : {0.0, 20.0, 22.0}) {
      auto window = parsed(R"({"id": "w", "shape": {"kind": "rectangle", "along_mm": 20,
                              "round_mm": 12}, "at": {"z_mm": 300}})");
      window = with(with(window, "at/girth_mm", girth), "wall", wall);
      const auto asked = with(rail(), "cutouts", api::Json{api::Json::Array{window}});
      const auto answer = post(kParts, asked);
      ASSERT_FALSE(answer.outcome.error) << wall << girth << answer.outcome.body.substr(0, 600);
      const double radius = number(answer.body, "request/cutouts/0/shape/corner_radius_mm");
      if (girth == 0.0) {
        EXPECT_EQ(radius, 0.5 * number(answer.body, "request/kerf_mm"));
      } else {
        EXPECT_GT(radius, 0.5 * number(answer.body, "request/kerf_mm"));
      }
      const auto tighter = with(asked, "cutouts/0/shape/corner_radius_mm", radius - 0.005);
      EXPECT_TRUE(post(kParts, tighter).outcome.error) << wall << girth;
    }
}

/// A radius that nobody gave is never at fault: a turned square is cut, or told its true cause.
TEST(SectionPartCutouts, ADefaultRadiusIsNeverRefused) {
  std::size_t cut = 0, open = 0;
  for (const char* tilt : {"axial", "free"})
    for (const double angle : {30.0, 60.0})
      for (double girth = 12.0; girth < 24.0; girth += 0.25) {
        auto body = parsed(R"({"target": {"size": "SHS 40x40x3 EN 10219", "length_mm": 400},
            "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "kerf_mm": 1.5,
            "cutouts": [{"id": "c", "shape": {"kind": "rectangle", "along_mm": 12, "round_mm": 12},
                         "at": {"z_mm": 200}}]})");
        body = with(with(std::move(body), "cutouts/0/at/girth_mm", girth), "cutouts/0/tilt", tilt);
        const auto answer = post(kParts, with(std::move(body), "cutouts/0/shape/angle_deg", angle));
        ++(answer.outcome.error ? open : cut);
        if (!answer.outcome.error) continue;
        EXPECT_EQ(text(answer.body, "errors/0/code"), "open_profile")
            << girth << tilt << answer.outcome.body.substr(0, 600);
      }
  EXPECT_GT(cut, 40u);
  EXPECT_GT(open, 20u);
}

TEST(SectionPartCutouts, AllOfThemAreInEveryFile) {
  auto body = with_cutout(
      R"({"id": "bolt", "shape": {"kind": "circle", "diameter_mm": 11},
          "at": {"z_mm": 80, "face": 2, "offset_mm": 6}, "wall": "through"})");
  body =
      with(body, "cutouts",
           api::Json{api::Json::Array{
               at(body, "cutouts/0"),
               parsed(R"({"id": "slot", "shape": {"kind": "slot", "length_mm": 30, "width_mm": 10},
                 "at": {"z_mm": 400, "face": 1}})")}});
  const auto count = [&](const char* query, const std::string& what) {
    const auto posted = post(kParts, api::dump(body), query);
    EXPECT_FALSE(posted.outcome.error) << query << posted.outcome.body.substr(0, 800);
    const auto& in = posted.outcome.body;
    std::size_t n = 0;
    for (auto at = in.find(what); at != std::string::npos; at = in.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("format=nc1", "\r\nBO\r\n"), 2u);
  EXPECT_EQ(count("format=nc1", "\r\nIK\r\n"), 1u);
  EXPECT_EQ(count("format=dxf", "bolt far:"), 1u);
  EXPECT_GE(count("format=step", "cut-out bolt far"), 1u);
  EXPECT_GE(count("format=svg", "slot 30 x 10"), 1u);
  EXPECT_GE(count("format=csv", "cut-out slot"), 1u);
}

/// A saw along a plane leaves the outer edge in it. A wall cut square does not: sawn at the stated
/// lengths it would be another part, so no tilt of a blade is stated.
TEST(SectionPartRequests, OnlyAnEndThatASawMakesHasItsTilt) {
  const auto tilts = [](const std::string& end) {
    const auto answer = post("/v1/parts", *api::parse(R"({"target": {"size":
        "RHS 100x60x4 EN 10219", "length_mm": 600}, "kerf_mm": 0, "ends": {"start": {"cutters":
        [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [1, 0, 1]}], "root_surface": "inner",
        "smoothing": {"method": "none"}, )" + end + R"(}, "finish": {"square_at_mm": 0}}})"));
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 400);
    const auto& part = at(answer.body, "result");
    const double rise =
        number(part, "side_lengths/face_mm/2") - number(part, "side_lengths/face_mm/0");
    EXPECT_EQ(number(part, "ends/finish/faces/0/saw_tilt_deg"), 0.0);
    const double wanted[] = {45.0, 0.0, -45.0, 0.0};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& face = at(part, "ends/start/faces/" + std::to_string(i));
      if (face.find("saw_tilt_deg") != nullptr) {
        EXPECT_NEAR(number(face, "saw_tilt_deg"), wanted[i], 1e-9);
      }
    }
    return std::pair{at(part, "ends/start/faces/0").find("saw_tilt_deg") != nullptr,
                     std::abs(rise)};
  };
  const auto [flush, whole] = tilts(R"("groove": {"rule": "none"}, "contact": "inner")");
  EXPECT_TRUE(flush);
  EXPECT_NEAR(whole, 100.0, 1e-9);
  const auto [square, less] = tilts(R"("groove": {"rule": "square"}, "contact": "auto")");
  EXPECT_FALSE(square);
  EXPECT_LT(less, 96.1);
}

}  // namespace tubecut::testing::section_parts
