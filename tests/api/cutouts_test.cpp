#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "tests/api/part_pulses.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

constexpr const char* kParts = "/v1/parts";

Json json(const std::string& text) { return *api::parse(text); }

/// A tube of 88.9 x 5, 400 long, square at both ends, with these cut-outs.
Json part_with(Json cutouts) {
  return with(json(R"({"target": {"outer_diameter_mm": 88.9, "wall_mm": 5, "length_mm": 400},
                       "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                       "kerf_mm": 1.5})"),
              "cutouts", std::move(cutouts));
}

Json list(const std::string& one) { return json("[" + one + "]"); }

std::string circle(const char* rest = "") {
  return std::string(R"({"id": "p", "shape": {"kind": "circle", "diameter_mm": 30},
                         "at": {"z_mm": 100, "phi_deg": 40})") +
         rest + "}";
}

/// The golden file's contour pieces as a request has them, on the local plane.
Json on_the_wire(Json cutout) {
  const auto& shape = at(cutout, "shape");
  if (text(shape, "kind") != "contour") return cutout;
  Json::Array pieces;
  for (const auto& piece : *at(shape, "pieces").as<Json::Array>()) {
    const auto& all = *piece.as<Json::Array>();
    pieces.push_back(
        Json{Json::Object{{"kind", all[0]}, {"to_mm", Json{Json::Array{all[1], all[2]}}}}});
  }
  auto out = with(std::move(cutout), "shape",
                  Json{Json::Object{{"kind", Json{"contour"}},
                                    {"start_mm", at(shape, "start")},
                                    {"pieces", Json{std::move(pieces)}}}});
  return out;
}

TEST(Cutouts, AreTheIndependentProgramsInThePartsAnswer) {
  const auto all = golden("cutouts.json");
  const auto& expected = (*at(all, "cutouts").as<Json::Array>())[1];
  ASSERT_EQ(text(expected, "name"), "round_circle_normal");
  const auto made = post(kParts, part_with(list(circle(R"(, "tilt": "free")"))));
  ASSERT_FALSE(made.outcome.error) << made.outcome.body.substr(0, 1500);
  const auto& group = at(made.body, "result/cutouts/0");
  EXPECT_NEAR(number(group, "area_outer_mm2"), number(expected, "area_outer"), 1e-6);
  EXPECT_NEAR(number(group, "volume_mm3"), number(expected, "volume"), 1e-5);
  const auto phi = numbers(group, "points/phi_deg"), z = numbers(group, "points/z_mm"),
             inner = numbers(group, "points/phi_inner_deg");
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const double b = 44.45 * std::sin((phi[i] - 40.0) * kRadPerDeg);
    EXPECT_NEAR(std::hypot(b, z[i] - 100.0), 15.0, 1e-9);
    EXPECT_NEAR(39.45 * std::sin((inner[i] - 40.0) * kRadPerDeg), b, 1e-9);
  }
  const double whole =
      number(post(kParts, part_with(Json{Json::Array{}})).body, "result/lengths/volume_mm3");
  EXPECT_NEAR(whole - number(made.body, "result/lengths/volume_mm3"), number(expected, "volume"),
              1e-5);
}

TEST(Cutouts, AreRefusedWhereTheIndependentProgramRefusesThem) {
  const auto all = golden("cutouts.json");
  std::size_t seen = 0;
  for (const auto& one : *at(all, "refusals").as<Json::Array>()) {
    const auto name = text(one, "name");
    Json::Array cutouts;
    for (const auto& cutout : *at(one, "cutouts").as<Json::Array>())
      cutouts.push_back(with(on_the_wire(cutout), "tilt", Json{"free"}));
    const auto refused = post(kParts, part_with(Json{std::move(cutouts)}));
    ASSERT_TRUE(refused.outcome.error) << name;
    EXPECT_EQ(text(refused.body, "errors/0/code"), text(one, "code")) << name;
    EXPECT_EQ(text(refused.body, "errors/0/pointer"), text(one, "pointer")) << name;
    EXPECT_EQ(at(refused.body, "errors").as<Json::Array>()->size(), 1u) << refused.outcome.body;
    ++seen;
  }
  EXPECT_EQ(seen, 19u);
}

TEST(Cutouts, TheEchoIsTheSameJob) {
  const auto first = post(
      kParts,
      part_with(list(R"({"id": "w", "shape": {"kind": "rectangle", "along_mm": 40, "round_mm": 20},
                         "at": {"z_mm": 100, "girth_mm": 50}})")));
  ASSERT_FALSE(first.outcome.error) << first.outcome.body.substr(0, 1500);
  const auto again = post(kParts, at(first.body, "request"));
  EXPECT_EQ(text(first.body, "job/input_sha256"), text(again.body, "job/input_sha256"));
  EXPECT_EQ(text(first.body, "job/result_sha256"), text(again.body, "job/result_sha256"));
  EXPECT_GT(number(first.body, "request/cutouts/0/shape/corner_radius_mm"), 0.75);
}

TEST(Cutouts, ARefusedSideOfARectangleIsOneError) {
  for (const char* sides : {R"("along_mm": 1e-300, "round_mm": 20)", R"("round_mm": 20)",
                            R"("along_mm": 40, "round_mm": "x")"}) {
    const auto refused = post(
        kParts, part_with(list(R"({"id": "w", "shape": {"kind": "rectangle", )" +
                               std::string(sides) + R"(}, "at": {"z_mm": 100, "girth_mm": 50}})")));
    ASSERT_TRUE(refused.outcome.error) << sides;
    EXPECT_EQ(at(refused.body, "errors").as<Json::Array>()->size(), 1u) << refused.outcome.body;
    EXPECT_TRUE(text(refused.body, "errors/0/pointer").starts_with("/cutouts/0/shape/")) << sides;
  }
  const auto neither = post(kParts, part_with(list(R"({"id": "w", "shape": {"kind": "rectangle"},
                                                       "at": {"z_mm": 100, "girth_mm": 50}})")));
  ASSERT_TRUE(neither.outcome.error);
  EXPECT_EQ(at(neither.body, "errors").as<Json::Array>()->size(), 2u) << neither.outcome.body;
}

/// The default of a rectangle's corners is calculated from the tube, the place and the pattern; of
/// refused ones it is not.
TEST(Cutouts, ARefusedTubeOrPatternIsItsOwnErrorWithARectangle) {
  const auto refused = [](const std::string& target, const std::string& pattern) {
    const auto body =
        R"({"target": )" + target +
        R"(, "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "kerf_mm": 0.5,
           "cutouts": [{"id": "w", "shape": {"kind": "rectangle", "along_mm": 20, "round_mm": 10},
           "at": {"z_mm": 100, "face": 2})" +
        pattern + "}]}";
    return post(kParts, std::string_view(body));
  };
  const auto tube = [](double height, double width, const char* corners) {
    return R"({"kind": "rectangular_tube", "length_mm": 300, "wall_mm": 2, "height_mm": )" +
           std::to_string(height) + R"(, "width_mm": )" + std::to_string(width) + ", " + corners +
           "}";
  };
  for (const char* corners :
       {R"("corner_radius_mm": 4)", R"("corners": "astm_a500")", R"("corners": "en_10219")"})
    for (const double side : {-1.0, 0.0, 2.0, 4.9, 5001.0, 6000.0})
      for (const bool across : {false, true}) {
        const auto answer =
            refused(tube(across ? 60 : side, across ? side : 60, corners), std::string());
        ASSERT_TRUE(answer.outcome.error) << side;
        EXPECT_TRUE(text(answer.body, "errors/0/pointer").starts_with("/target/"))
            << answer.outcome.body;
      }
  for (const char* faces : {"[1, 2, 99999]", "[1, -1]", "[0.118]", "[1, 1]", "[]"}) {
    const auto answer =
        refused(tube(60, 60, R"("corner_radius_mm": 4)"),
                R"(, "pattern": {"kind": "faces", "faces": )" + std::string(faces) + "}");
    ASSERT_TRUE(answer.outcome.error) << faces;
    EXPECT_TRUE(text(answer.body, "errors/0/pointer").starts_with("/cutouts/0/pattern/faces"))
        << answer.outcome.body;
  }
}

TEST(Cutouts, FromTheFinishIsTheLengthLessFromTheStart) {
  const auto start = post(kParts, part_with(list(circle())));
  const auto finish =
      post(kParts, part_with(list(R"({"id": "p", "shape": {"kind": "circle", "diameter_mm": 30},
                                 "at": {"z_mm": 300, "phi_deg": -140, "from": "finish", "opposite": true}})")));
  const auto a = numbers(start.body, "result/cutouts/0/points/z_mm");
  const auto b = numbers(finish.body, "result/cutouts/0/points/z_mm");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9);
  EXPECT_NEAR(number(finish.body, "result/cutouts/0/instances/0/phi_deg"), 40.0, 1e-9);
}

/// A row along and round the tube, of more than a turn, is as many cut-outs stated one by one: in
/// place, in mass, and as cuts of the program.
TEST(Cutouts, AHelicalRowIsItsHolesOneByOne) {
  const auto hole = [](int k, const std::string& more) {
    return R"({"id": "h)" + std::to_string(k) +
           R"(", "shape": {"kind": "circle", "diameter_mm": 8}, "at": {"z_mm": )" +
           std::to_string(60 + 25 * k) + R"(, "phi_deg": )" + std::to_string(30.0 + 137.5 * k) +
           "}" + more + "}";
  };
  std::string singles = hole(0, "");
  for (int k = 1; k < 10; ++k) singles += ", " + hole(k, "");
  const auto row = part_with(list(hole(
      0, R"(, "pattern": {"kind": "linear", "count": 10, "pitch_mm": 25, "pitch_deg": 137.5})")));
  const auto made = post(kParts, row), apart = post(kParts, part_with(list(singles)));
  ASSERT_FALSE(made.outcome.error) << made.outcome.body.substr(0, 500);
  ASSERT_FALSE(apart.outcome.error) << apart.outcome.body.substr(0, 500);
  EXPECT_NEAR(number(made.body, "result/lengths/mass_kg"),
              number(apart.body, "result/lengths/mass_kg"), 1e-12);
  for (int k = 0; k < 10; ++k) {
    const auto of_row = "result/cutouts/0/instances/" + std::to_string(k);
    const auto single = "result/cutouts/" + std::to_string(k) + "/instances/0";
    const double turned =
        number(made.body, of_row + "/phi_deg") - number(apart.body, single + "/phi_deg");
    EXPECT_NEAR(std::remainder(turned, 360.0), 0.0, 1e-9) << k;
    EXPECT_NEAR(number(made.body, of_row + "/z_mm"), number(apart.body, single + "/z_mm"), 1e-9);
  }
  const auto body = dump(row);
  const auto program = post(kParts, std::string_view(body), "format=gcode&speed_mm_min=600");
  ASSERT_FALSE(program.outcome.error) << program.outcome.body.substr(0, 500);
  std::size_t cuts = 0;
  for (auto at = program.outcome.body.find("(cut: cut-out h0"); at != std::string::npos;
       at = program.outcome.body.find("(cut: cut-out h0", at + 1))
    ++cuts;
  EXPECT_EQ(cuts, 10u);
}

TEST(Cutouts, AStraightToolPassesWhereTheTorchDoesNotLean) {
  for (const char* tilt : {"axial", "none"}) {
    const auto made = post(
        kParts, part_with(list(circle(
                    (R"(, "wall": "through", "tilt": ")" + std::string(tilt) + "\"").c_str()))));
    ASSERT_FALSE(made.outcome.error);
    for (const char* side : {"0", "1"}) {
      const auto points = std::string("result/cutouts/") + side + "/points/";
      const auto phi = numbers(made.body, points + "phi_deg"),
                 inner = numbers(made.body, points + "phi_inner_deg"),
                 z = numbers(made.body, points + "z_mm");
      for (std::size_t i = 0; i < phi.size(); ++i) {
        EXPECT_EQ(phi[i], inner[i]);
        EXPECT_NEAR(std::hypot(39.45 * std::sin((inner[i] - 40.0) * kRadPerDeg), z[i] - 100.0),
                    15.0, 1e-9);
      }
    }
  }
}

TEST(Cutouts, AcceptHoldsTheirWebsAndSizes) {
  const auto two = list(circle() + R"(, {"id": "q", "shape": {"kind": "circle", "diameter_mm": 8},
                                         "at": {"z_mm": 130, "phi_deg": 40}, "wall": "developed"})");
  const auto made =
      post(kParts, with(part_with(two), "accept", json(R"({"min_web_mm": 12, "min_diameter_mm": 7,
                                               "min_hole_to_end_mm": 86})")));
  ASSERT_FALSE(made.outcome.error) << made.outcome.body.substr(0, 1500);
  EXPECT_NEAR(number(made.body, "result/cutout_report/web/width_mm"), 11.0, 2e-3);
  EXPECT_NEAR(number(made.body, "result/cutout_report/to_end/width_mm"), 85.0, 2e-3);
  EXPECT_EQ(text(made.body, "verdict/status"), "reject");
}

TEST(Cutouts, AllOfThemAreInEveryFile) {
  const auto body =
      api::dump(part_with(list(circle(R"(, "wall": "through")") +
                               R"(, {"id": "s", "shape": {"kind": "slot", "length_mm": 30,
                                                   "width_mm": 10}, "at": {"z_mm": 250, "phi_deg": 0}})")));
  const auto text_of = [&](const char* query) {
    const auto posted = post(kParts, body, query);
    EXPECT_FALSE(posted.outcome.error) << query << posted.outcome.body.substr(0, 800);
    return posted.outcome.body;
  };
  const auto count = [](const std::string& in, const std::string& what) {
    std::size_t n = 0;
    for (auto at = in.find(what); at != std::string::npos; at = in.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count(text_of("format=nc1"), "\r\nBO\r\n"), 2u);
  EXPECT_EQ(count(text_of("format=nc1"), "\r\nIK\r\n"), 1u);
  EXPECT_EQ(count(text_of("format=dxf"), "p far:"), 1u);
  EXPECT_GE(count(text_of("format=step"), "cut-out p far"), 1u);
  EXPECT_GE(count(text_of("format=svg"), "slot 30 x 10"), 1u);
  EXPECT_GE(count(text_of("format=csv"), "cut-out s"), 1u);
  EXPECT_GE(count(text_of("format=gcode&speed_mm_min=1200&lead_mm=3"), "cut-out p"), 2u);
}

/// If only cut-outs can make a requested opening, because there are more than 256 or because its
/// branch is no tube, the refusal names them.
TEST(Cutouts, RefusedHolesNameThem) {
  const auto hole = json(R"({"branch": {"outer_diameter_mm": 6, "wall_mm": 1,
                                         "axis": {"point_mm": [0, 0, 100], "direction": [1, 0, 0]}},
                             "groove": {"rule": "square"}, "tilt": "none"})");
  auto body = part_with(Json{Json::Array{}});
  const auto many = post(kParts, with(body, "holes", Json{Json::Array(257, hole)}));
  ASSERT_TRUE(many.outcome.error);
  EXPECT_EQ(text(many.body, "errors/0/pointer"), "/holes");
  EXPECT_NE(text(many.body, "errors/0/hint").find("cutouts"), std::string::npos);
  auto slot = with(hole, "branch/kind", Json{"slot"});
  const auto other = post(kParts, with(body, "holes", Json{Json::Array{std::move(slot)}}));
  ASSERT_TRUE(other.outcome.error);
  EXPECT_EQ(text(other.body, "errors/0/pointer"), "/holes/0/branch/kind");
  EXPECT_EQ(text(other.body, "errors/0/code"), "unsupported_combination");
  EXPECT_NE(text(other.body, "errors/0/hint").find("cutouts"), std::string::npos);
}

/// A shape wider than the bore is refused as that, with the bore; a pattern that leaves the part at
/// the finish, with the sign of its pitch.
TEST(Cutouts, RefusalsNameTheCause) {
  const auto wide = post(kParts, part_with(list(R"({"id": "w", "at": {"z_mm": 150, "phi_deg": 0},
                             "shape": {"kind": "circle", "diameter_mm": 500}})")));
  ASSERT_TRUE(wide.outcome.error);
  EXPECT_EQ(text(wide.body, "errors/0/pointer"), "/cutouts/0/shape");
  EXPECT_EQ(text(wide.body, "errors/0/code"), "open_profile");
  const auto past =
      post(kParts, part_with(list(R"({"id": "b", "at": {"z_mm": 40, "phi_deg": 0, "from": "finish"},
                             "shape": {"kind": "circle", "diameter_mm": 10},
                             "pattern": {"kind": "linear", "count": 3, "pitch_mm": 100}})")));
  ASSERT_TRUE(past.outcome.error);
  EXPECT_EQ(text(past.body, "errors/0/pointer"), "/cutouts/0/pattern");
  EXPECT_NE(text(past.body, "errors/0/hint").find("negative"), std::string::npos);
  const auto none = post(kParts, part_with(list(R"({"id": "b", "at": {"z_mm": 40, "phi_deg": 0},
                             "shape": {"kind": "circle", "diameter_mm": 10},
                             "pattern": {"kind": "linear", "count": 3}})")));
  ASSERT_TRUE(none.outcome.error);
  EXPECT_EQ(text(none.body, "errors/0/pointer"), "/cutouts/0/pattern/pitch_mm");
}

/// A pattern is its places: steps along the tube too never come back, and those round it only after
/// whole turns. The limit of a refusal is accepted.
TEST(Cutouts, APatternIsItsPlacesHoweverOftenItGoesRound) {
  const auto one = [](const std::string& id, double z, double phi) {
    auto out = json(R"({"shape": {"kind": "circle", "diameter_mm": 8}, "at": {}})");
    out = with(with(std::move(out), "id", Json{id}), "at/z_mm", Json{z});
    return with(std::move(out), "at/phi_deg", Json{phi});
  };
  const auto of = [&](const std::string& pattern) {
    return part_with(Json{Json::Array{with(one("h", 100, 0), "pattern", json(pattern))}});
  };
  const auto expect_same = [](const Json& pattern, const Json& places) {
    const auto got = post(kParts, pattern), wanted = post(kParts, places);
    ASSERT_FALSE(got.outcome.error) << got.outcome.body.substr(0, 800);
    ASSERT_FALSE(wanted.outcome.error) << wanted.outcome.body.substr(0, 800);
    for (const char* path :
         {"result/cutout_report/web/width_mm", "result/cutout_report/net_section/area_mm2",
          "result/lengths/volume_mm3"})
      EXPECT_NEAR(number(got.body, path), number(wanted.body, path), 1e-6) << path;
  };
  expect_same(of(R"({"kind": "linear", "count": 3, "pitch_mm": 40, "pitch_deg": 180})"),
              part_with(Json{Json::Array{one("a", 100, 0), one("b", 140, 180), one("c", 180, 0)}}));
  expect_same(of(R"({"kind": "round", "count": 9, "pitch_deg": 80})"),
              of(R"({"kind": "round", "count": 9, "pitch_deg": 40})"));
  const auto expect_limit = [&](const std::string& head, const std::string& tail, int count,
                                int most, const char* member) {
    const auto refused = post(kParts, of(head + std::to_string(count) + tail));
    ASSERT_TRUE(refused.outcome.error) << head;
    EXPECT_EQ(text(refused.body, "errors/0/code"), "pattern_wraps") << head;
    EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/cutouts/0/pattern/" + std::string(member));
    EXPECT_EQ(number(refused.body, "errors/0/limit"), most) << head;
    const auto taken = post(kParts, of(head + std::to_string(most) + tail));
    EXPECT_FALSE(taken.outcome.error) << taken.outcome.body.substr(0, 800);
  };
  expect_limit(R"({"kind": "round", "count": )", R"(, "pitch_deg": -80})", 20, 9, "count");
  expect_limit(R"({"kind": "linear", "count": )", R"(, "pitch_deg": 180})", 3, 2, "count");
  expect_limit(R"({"kind": "grid", "along": {"count": 2, "pitch_mm": 40}, "round": {"count": )",
               R"(, "pitch_deg": 120}})", 4, 3, "round/count");
  // An odd row of a staggered grid lies between those of the even ones.
  expect_limit(R"({"kind": "grid", "along": {"count": 2, "pitch_mm": 40}, "round": {"count": )",
               R"(, "pitch_deg": 120}, "stagger": "along"})", 7, 6, "round/count");
}

/// A cut-out that meets a hole names it by its branch, else by its field.
TEST(Cutouts, TheHoleThatOneMeetsIsNamed) {
  const auto hole = [](double height) {
    return with(json(R"({"branch": {"outer_diameter_mm": 42.4, "wall_mm": 4, "inclination_deg": 90,
                          "clocking_deg": 90, "offset_mm": 0}, "joint": {"kind": "set_in",
                          "gap_mm": 1}, "groove": {"rule": "none"}})"),
                "branch/height_mm", Json{height});
  };
  for (const std::size_t met : {0, 1}) {
    auto body = part_with(list(R"({"id": "c", "shape": {"kind": "circle", "diameter_mm": 10},
                                   "at": {"z_mm": )" +
                               std::to_string(met == 0 ? 120 : 280) + R"(, "phi_deg": 0}})"));
    body = with(std::move(body), "holes", Json{Json::Array{hole(120), hole(280)}});
    const auto field = "holes/" + std::to_string(met);
    EXPECT_EQ(text(post(kParts, body).body, "errors/0/hint"), "c meets " + field);
    body = with(std::move(body), field + "/branch/id", Json{"B1"});
    EXPECT_EQ(text(post(kParts, body).body, "errors/0/hint"), "c meets the hole for B1");
  }
}

/// A limit that a refusal states is accepted when it is followed, and what fits nowhere is told so.
TEST(Cutouts, LimitsNearTheBoreAreAcceptedAndWhatFitsNowhereIsTold) {
  const auto sent = [](const std::string& shape, const std::string& wall, double z) {
    return post(kParts, json(R"({"preset": "tube_laser", "kerf_mm": 0.3, "target":
        {"size": "CHS 42.4x4", "length_mm": 300}, "ends": {"start": {"square_at_mm": 0},
        "finish": {"square_at_mm": 0}}, "cutouts": [{"id": "c", "at": {"phi_deg": 0, "z_mm": )" +
                             std::to_string(z) + R"(}, "shape": )" + shape + R"(, "wall": ")" +
                             wall + "\"}]}"));
  };
  const auto circle = [](double d) {
    return R"({"kind": "circle", "diameter_mm": )" + std::to_string(d) + "}";
  };
  double asked = 40.0;
  for (int step = 0;; ++step) {  // the bore's width first, then what the beam can follow
    ASSERT_LT(step, 3);
    const auto answer = sent(circle(asked), "through", 150.0);
    if (!answer.outcome.error) break;
    ASSERT_EQ(text(answer.body, "errors/0/pointer"), "/cutouts/0/shape");
    const double limit = number(answer.body, "errors/0/limit");
    ASSERT_LT(limit, asked);
    asked = limit;
  }
  EXPECT_GT(asked, 34.39);
  const auto window = R"({"kind": "rectangle", "along_mm": 400, "round_mm": 20})";
  for (const double z : {150.0, -100.0, 500.0}) {
    const auto answer = sent(window, "developed", z);
    ASSERT_TRUE(answer.outcome.error);
    EXPECT_EQ(text(answer.body, "errors/0/code"), "cutout_off_part");
    EXPECT_EQ(text(answer.body, "errors/0/pointer"), "/cutouts/0/shape") << z;
    EXPECT_NE(text(answer.body, "errors/0/hint").find("does not fit"), std::string::npos) << z;
  }
}

TEST(Cutouts, AThousandAndMoreAreOneShapeMoved) {
  const auto made = post(kParts, example("parts/perforated-tube.json"));
  ASSERT_FALSE(made.outcome.error) << made.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(made.body, "result/cutouts").as<Json::Array>()->size(), 1u);
  EXPECT_EQ(at(made.body, "result/cutouts/0/instances").as<Json::Array>()->size(), 1792u);
  // Staggered rows: the nearest are half a pitch along and one round.
  const double round = 57.15 * 11.25 * kRadPerDeg;
  EXPECT_NEAR(number(made.body, "result/cutout_report/web/width_mm"),
              std::min(10.0, std::hypot(5.0, round * 55.15 / 57.15)) - 6.0, 0.2);
}

/// A slit is answered as the slot that the beam takes, and is in every file; its program has one
/// pierce and no lead.
TEST(Cutouts, ASlitIsOnePassOfTheBeam) {
  const auto body =
      part_with(list(R"({"id": "s", "shape": {"kind": "slit", "length_mm": 40, "pierce": "end"},
                         "at": {"z_mm": 200, "phi_deg": 40}})"));
  const auto made = post(kParts, body);
  ASSERT_FALSE(made.outcome.error) << made.outcome.body.substr(0, 1500);
  const auto slot = post(kParts, part_with(list(R"({"id": "s", "at": {"z_mm": 200, "phi_deg": 40},
          "shape": {"kind": "slot", "length_mm": 41.5, "width_mm": 1.5}, "tilt": "free"})")));
  ASSERT_TRUE(slot.outcome.error);  // no beam cuts round it
  EXPECT_NEAR(number(made.body, "result/cutouts/0/instances/0/z_to_mm"), 220.75, 1e-9);
  const double torch_to =
      std::ranges::max(numbers(made.body, "result/cutouts/0/points/torch_z_mm"));
  EXPECT_NEAR(torch_to, 220.0, 1e-9);
  for (const double a : numbers(made.body, "result/cutouts/0/points/a_deg")) EXPECT_EQ(a, 0.0);
  const auto again = post(kParts, at(made.body, "request"));
  EXPECT_EQ(text(made.body, "job/result_sha256"), text(again.body, "job/result_sha256"));
  for (const char* query : {"format=dxf", "format=step", "format=svg", "format=csv"})
    EXPECT_FALSE(post(kParts, api::dump(body), query).outcome.error) << query;
  const auto nc1 = post(kParts, api::dump(body), "format=nc1").outcome.body;
  EXPECT_NE(nc1.find("shape: slit 40; pierce end; kerf 1.5"), std::string::npos);
  const auto program =
      post(kParts, api::dump(body), "format=gcode&speed_mm_min=1200&lead_mm=3").outcome.body;
  const auto cut = program.find("(cut: cut-out s)");
  ASSERT_NE(cut, std::string::npos);
  const auto moves = program.substr(cut, program.find("(cut: finish)") - cut);
  EXPECT_NE(moves.find("G0 X180.00000"), std::string::npos) << moves.substr(0, 600);
  EXPECT_NE(moves.find("G1 X220.00000"), std::string::npos);
  EXPECT_NE(moves.find("a slit has no leads"), std::string::npos);
}

TEST(Cutouts, ASlitIsRefusedWhereOnePassDoesNotMakeIt) {
  const auto refused = [](const char* rest, double kerf = 1.5) {
    const auto answer =
        post(kParts, with(part_with(list(R"({"id": "s", "at": {"z_mm": 200, "phi_deg": 0}, )" +
                                         std::string(rest) + "}")),
                          "kerf_mm", Json{kerf}));
    EXPECT_TRUE(answer.outcome.error) << rest;
    return text(answer.body, "errors/0/code") + " " + text(answer.body, "errors/0/pointer");
  };
  EXPECT_EQ(refused(R"("shape": {"kind": "slit", "length_mm": 40, "angle_deg": 90})"),
            "unsupported_combination /cutouts/0/shape/angle_deg");
  EXPECT_EQ(refused(R"("shape": {"kind": "slit", "length_mm": 40})", 0.0),
            "out_of_range /cutouts/0/shape");
  const auto pulses =
      pulses_of(part_with(list(R"({"id": "s", "shape": {"kind": "slit", "length_mm": 40},
                                   "at": {"z_mm": 200, "phi_deg": 40}})")));
  ASSERT_TRUE(pulses.outcome.error);
  EXPECT_NE(pulses.outcome.body.find("/part/cutouts/0/shape/kind"), std::string::npos)
      << pulses.outcome.body.substr(0, 600);
}

}  // namespace
}  // namespace tubecut::testing
