// Plates of a frame: what the answer states of them, and what of a request is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::frame_plates {

using api::Json;

constexpr const char* kFrames = "/v1/frames";

Json parsed(const std::string& text) { return *api::parse(text); }

/// A post on a base plate, and a rail through a web plate.
Json frame() {
  return parsed(R"({
    "members": [
      {"id": "P", "start_mm": [0, 0, 0], "end_mm": [0, 0, 1000], "outer_diameter_mm": 88.9,
       "wall_mm": 4},
      {"id": "R", "start_mm": [300, -200, 500], "end_mm": [300, 200, 500],
       "outer_diameter_mm": 42.4, "wall_mm": 3.2}],
    "plates": [
      {"id": "BP", "point_mm": [0, 0, 0], "normal": [0, 0, 2], "up": [0, 1, 0],
       "thickness_mm": 15,
       "outline": {"kind": "rectangle", "width_mm": 200, "height_mm": 180},
       "cutouts": [{"id": "bolt", "shape": {"kind": "circle", "diameter_mm": 18},
                    "at_mm": [-70, -60],
                    "pattern": {"kind": "grid", "columns": 2, "rows": 2, "column_pitch_mm": 140,
                                "row_pitch_mm": 120}}]},
      {"id": "W", "point_mm": [300, 0, 500], "normal": [0, 1, 0], "up": [0, 0, 1],
       "thickness_mm": 10, "outline": {"kind": "circle", "diameter_mm": 120}}],
    "joints": [{"between": ["BP", "P"], "kind": "set_on", "gap_mm": 2},
               {"between": ["R", "W"], "kind": "through", "gap_mm": 0.5}],
    "defaults": {"root_surface": "inner", "groove": {"rule": "half_dihedral"},
                 "smoothing": {"method": "none"}},
    "kerf_mm": 1.5, "sampling": {"tolerance_mm": 0.1}})");
}

TEST(FramePlates, AreListedWithHolesMarksAndMass) {
  const auto answer = post(kFrames, frame());
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body;
  const auto& base = at(answer.body, "result/plates/0");
  EXPECT_EQ(text(base, "plate"), "BP");
  EXPECT_EQ(number(base, "width_mm"), 200.0);
  EXPECT_EQ(number(base, "height_mm"), 180.0);
  const double area = 200.0 * 180.0 - 4.0 * kPi * 81.0;
  EXPECT_NEAR(number(base, "area_mm2"), area, 1e-5);
  EXPECT_NEAR(number(base, "mass_kg"), area * 15.0 * 7850e-9, 1e-5);
  EXPECT_NEAR(number(base, "web_mm"), 21.0, 1e-6);
  EXPECT_EQ(at(base, "holes").as<Json::Array>()->size(), 4u);
  EXPECT_EQ(text(base, "marks/0/part"), "P");
  EXPECT_EQ(text(base, "marks/0/face"), "front");
  const auto& web = at(answer.body, "result/plates/1");
  EXPECT_EQ(text(web, "holes/0/part"), "R");
  EXPECT_NEAR(number(web, "holes/0/diameter_mm"), 43.4, 1e-9);
  EXPECT_EQ(number(answer.body, "result/totals/plates"), 2.0);
  EXPECT_NEAR(number(answer.body, "result/totals/plates_mass_kg"),
              number(base, "mass_kg") + number(web, "mass_kg"), 1e-5);
}

TEST(FramePlates, EndsAreCutAtTheFaceWithTheirGap) {
  const auto answer = post(kFrames, frame());
  const auto& joint = at(answer.body, "result/joints/0");
  EXPECT_EQ(text(joint, "branch"), "P");
  EXPECT_EQ(text(joint, "chord"), "BP");
  const auto& request = at(answer.body, "parts/0/answer/request");
  EXPECT_EQ(text(request, "ends/start/cutters/0/kind"), "plane");
  EXPECT_EQ(text(request, "ends/start/cutters/0/id"), "BP");
  EXPECT_EQ(number(request, "ends/start/joints/0/gap_mm"), 2.0);
  EXPECT_EQ(text(answer.body, "result/joints/1/kind"), "through");
  EXPECT_EQ(text(answer.body, "result/joints/1/hole"), "cut");
  EXPECT_NEAR(number(answer.body, "result/joints/1/fit_up/greatest_root_mm"), 0.5, 1e-9);
  EXPECT_NEAR(number(answer.body, "result/joints/1/weld_mm"), kPi * 43.4, 1e-6);
  // What passes through is not cut there.
  const auto& through = at(answer.body, "parts/1/answer/request");
  EXPECT_EQ(number(through, "ends/start/square_at_mm"), 0.0);
}

TEST(FramePlates, AnEndSetInIsFlushAtItsDepth) {
  auto body = with(frame(), "joints/0",
                   parsed(R"({"between": ["P", "BP"], "kind": "set_in", "gap_mm": 0.5})"));
  const auto answer = post(kFrames, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body;
  EXPECT_EQ(number(answer.body, "result/joints/0/depth_mm"), 15.0);
  EXPECT_NEAR(number(answer.body, "result/plates/0/holes/4/diameter_mm"), 89.9, 1e-9);
  const auto& request = at(answer.body, "parts/0/answer/request");
  EXPECT_EQ(text(request, "ends/start/groove/rule"), "none");
  EXPECT_EQ(number(request, "ends/start/joints/0/gap_mm"), 0.0);
  // The kerf is outside the part: it is 15 mm longer than between its work points.
  EXPECT_NEAR(number(answer.body, "parts/0/answer/result/lengths/long_mm"), 1015.0, 1e-6);
  body = with(body, "joints/0/depth_mm", 15.5);
  const auto refused = post(kFrames, body);
  EXPECT_NE(error_at(refused, "/joints/0/depth_mm"), nullptr) << refused.outcome.body;
}

TEST(FramePlates, EqualPlatesAreOne) {
  auto body = frame();
  auto& members = *const_cast<Json&>(at(body, "members")).as<Json::Array>();
  auto& plates = *const_cast<Json&>(at(body, "plates")).as<Json::Array>();
  auto& joints = *const_cast<Json&>(at(body, "joints")).as<Json::Array>();
  members.push_back(
      with(with(with(members[0], "id", "P2"), "start_mm/0", 700.0), "end_mm/0", 700.0));
  plates.push_back(with(with(plates[0], "id", "BP2"), "point_mm/0", 700.0));
  joints.push_back(with(joints[0], "between", parsed(R"(["P2", "BP2"])")));
  const auto answer = post(kFrames, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body;
  EXPECT_EQ(at(answer.body, "result/plates").as<Json::Array>()->size(), 2u);
  EXPECT_EQ(number(answer.body, "result/plates/0/count"), 2.0);
  EXPECT_EQ(text(answer.body, "result/plates/0/ids/1"), "BP2");
  plates[2] = with(plates[2], "cutouts/0/shape/diameter_mm", 19.0);
  const auto other = post(kFrames, body);
  EXPECT_EQ(at(other.body, "result/plates").as<Json::Array>()->size(), 3u);
}

TEST(FramePlates, ATubeThroughAPlateWithoutAJointIsReported) {
  auto body = frame();
  const_cast<Json&>(at(body, "joints")).as<Json::Array>()->pop_back();
  const auto answer = post(kFrames, body);
  ASSERT_FALSE(answer.outcome.error);
  EXPECT_EQ(text(answer.body, "warnings/0/code"), "members_overlap");
  EXPECT_EQ(text(answer.body, "warnings/0/pointer"), "/members/1");
  EXPECT_EQ(text(answer.body, "verdict/status"), "review");
}

/// The wall of the post is 4 mm thick, from a radius of 40.45 to one of 44.45.
/// A plate of 200 x 10 x 100 mm that stands `off` mm above the base plate's face, at an angle in
/// plan.
Json gusset(double off, double turned, const std::string& more = "") {
  const double c = std::cos(turned * kRadPerDeg), s = std::sin(turned * kRadPerDeg);
  const auto out = [](double v) { return std::to_string(std::round(v * 1e3) / 1e3); };
  return parsed(R"({"id": "G", "point_mm": [)" + out(-5.0 * s) + ", " + out(5.0 * c) + ", " +
                out(off + 50.0) + R"(], "normal": [)" + std::to_string(-s) + ", " +
                std::to_string(c) +
                R"(, 0], "up": [0, 0, 1], "thickness_mm": 10,
                   "outline": {"kind": "rectangle", "width_mm": 160, "height_mm": 100})" +
                more + "}");
}

/// Returns the depths that are told of plates that overlap.
std::vector<std::string> shared_by_plates(const Json& asked) {
  const auto answer = post(kFrames, asked);
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
  std::vector<std::string> out;
  for (const auto& w : *at(answer.body, "warnings").as<Json::Array>())
    if (text(w, "code") == "members_overlap" && text(w, "pointer").starts_with("/plates/"))
      out.push_back(text(w, "pointer") + text(w, "detail"));
  return out;
}

/// Plates that only touch, also turned in plan with three decimals, do not overlap; one that is
/// 0.4 mm deep in another does, whichever is given first.
TEST(FramePlates, PlatesThatOverlapAreReported) {
  const auto base = at(frame(), "plates/0");
  const auto both = [&](const Json& other, bool first) {
    auto asked = with(frame(), "members", Json{Json::Array{at(frame(), "members/0")}});
    asked = with(asked, "joints", Json{Json::Array{at(frame(), "joints/0")}});
    return with(asked, "plates", Json{first ? Json::Array{other, base} : Json::Array{base, other}});
  };
  for (const double turned : {0.0, 31.7, 90.0})
    for (const bool first : {true, false}) {
      for (const double off : {0.0, 0.02, 5.0})
        EXPECT_TRUE(shared_by_plates(both(gusset(off, turned), first)).empty()) << turned;
      for (const double off : {-0.4, -7.0, -14.6, -60.0}) {
        const auto found = shared_by_plates(both(gusset(off, turned), first));
        ASSERT_EQ(found.size(), 1U) << turned << " " << off;
        EXPECT_EQ(found[0].rfind("/plates/0it and " + std::string(first ? "BP" : "G"), 0), 0U)
            << found[0];
      }
    }
  // The same plate twice, side by side, and one on the other.
  for (const auto& [x, z, count] : {std::tuple{0.0, 0.0, 1U},
                                    {200.0, 0.0, 0U},
                                    {199.0, 0.0, 1U},
                                    {0.0, 15.0, 0U},
                                    {0.0, 14.0, 1U},
                                    {30.0, -14.0, 1U}}) {
    auto other = with(base, "id", Json{"second"});
    other = with(other, "point_mm", Json{Json::Array{x, 0.0, z}});
    EXPECT_EQ(shared_by_plates(both(other, false)).size(), count) << x << " " << z;
  }
}

/// A plate in the slot of another shares no metal with it.
TEST(FramePlates, APlateInASlotDoesNotOverlap) {
  for (const auto& [width, count] : {std::pair{10.4, 0U}, {10.0, 0U}, {8.0, 1U}}) {
    auto base = with(at(frame(), "plates/0"), "cutouts",
                     parsed(R"([{"id": "slot", "shape": {"kind": "rectangle", "width_mm": 161,
                                 "height_mm": )" +
                            std::to_string(width) + R"(}, "at_mm": [0, 0]}])"));
    auto asked = with(frame(), "members", Json{Json::Array{at(frame(), "members/1")}});
    asked = with(asked, "joints", Json{Json::Array{at(frame(), "joints/1")}});
    asked =
        with(asked, "plates", Json{Json::Array{base, at(frame(), "plates/1"), gusset(-40.0, 0.0)}});
    EXPECT_EQ(shared_by_plates(asked).size(), count) << width;
  }
}

TEST(FramePlates, AWallOverAnOpeningIsReported) {
  const auto over = [](double x, double diameter) {
    auto hole = parsed(R"({"id": "h", "shape": {"kind": "circle"}})");
    hole = with(with(hole, "shape/diameter_mm", diameter), "at_mm",
                Json{Json::Array{Json{x}, Json{0.0}}});
    const auto answer = post(kFrames, with(frame(), "plates/0/cutouts", Json{Json::Array{hole}}));
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body;
    const auto* all = at(answer.body, "warnings").as<Json::Array>();
    return all->empty() ? std::string() : text((*all)[0], "code") + text((*all)[0], "detail");
  };
  EXPECT_EQ(over(0.0, 80.0), "");   // a vent within the bore
  EXPECT_EQ(over(70.0, 40.0), "");  // a bolt hole next to the post
  EXPECT_EQ(over(0.0, 84.0), "wall_overhangsup to 1.55 mm of the wall lie over opening h of BP");
  EXPECT_EQ(over(44.0, 20.0), "wall_overhangsup to 4 mm of the wall lie over opening h of BP");
}

struct Mistake {
  const char *path, *value, *code, *pointer;
};

TEST(FramePlates, MistakesAreRefusedAtTheirFields) {
  const Mistake all[] = {
      {"plates/0/thickness_mm", "0", "out_of_range", "/plates/0/thickness_mm"},
      {"plates/0/normal", "[0, 0, 0]", "zero_length", "/plates/0/normal"},
      {"plates/0/up", "[0, 0, 1]", "bad_reference_direction", "/plates/0/up"},
      {"plates/0/id", "\"P\"", "duplicate_id", "/plates/0/id"},
      {"plates/0/holes", "[]", "unknown_field", "/plates/0/holes"},
      {"plates/0/outline/kind", "\"triangle\"", "bad_choice", "/plates/0/outline/kind"},
      {"plates/0/outline/along_mm", "5", "unknown_field", "/plates/0/outline/along_mm"},
      {"plates/0/outline/corner_radius_mm", "95", "out_of_range",
       "/plates/0/outline/corner_radius_mm"},
      {"plates/0/outline",
       R"({"kind": "contour", "start_mm": [0, 0], "pieces": [{"kind": "line", "to_mm": [9, 0]},
           {"kind": "line", "to_mm": [0, 9]}]})",
       "contour_open", "/plates/0/outline"},
      {"plates/0/cutouts/0/at_mm", "[-95, -60]", "cutout_off_part", "/plates/0/cutouts/0"},
      {"plates/0/cutouts/0/pattern/row_pitch_mm", "10", "cutouts_cross", "/plates/0/cutouts/0"},
      {"plates/0/cutouts/0/pattern/column_pitch_mm", "0", "out_of_range",
       "/plates/0/cutouts/0/pattern/column_pitch_mm"},
      {"plates/0/min_web_mm", "22", "out_of_range", "/plates/0/cutouts/0"},
      {"joints/0/kind", "\"mitre\"", "unsupported_combination", "/joints/0/kind"},
      {"joints/0/hole", "\"cut\"", "unsupported_combination", "/joints/0/hole"},
      {"joints/1/hole", "\"none\"", "unsupported_combination", "/joints/1/hole"},
      {"joints/1/end", "\"start\"", "unsupported_combination", "/joints/1/end"},
      {"joints/1/groove", R"({"rule": "none"})", "unsupported_combination", "/joints/1/groove"},
      {"joints/1/between", R"(["BP", "W"])", "bad_choice", "/joints/1/between"},
      {"joints/1/between", R"(["R", "BP"])", "no_contact", "/joints/1"},
      {"joints/1/gap_mm", "45", "cutout_off_part", "/joints/1"},
      {"members/0/start_mm/0", "0.5", "", ""},
      {"plates/0/point_mm", "[500, 0, 0]", "no_contact", "/joints/0"},
      {"plates/0/point_mm", "[0, 0, -1000]", "no_contact", "/joints/0"},
      {"plates/0/point_mm", "[0, 0, 200]", "no_contact", "/joints/0"},
      {"plates/0/point_mm", "[0, 0, 120]", "", ""},
      {"plates/0/cutouts/0",
       R"({"id": "window", "shape": {"kind": "rectangle", "width_mm": 100, "height_mm": 120},
           "at_mm": [0, 0]})",
       "no_contact", "/joints/0"},
  };
  for (const auto& one : all) {
    const auto answer = post(kFrames, with(frame(), one.path, parsed(one.value)));
    if (*one.code == '\0') {
      EXPECT_FALSE(answer.outcome.error) << one.path;
      continue;
    }
    const auto* error = error_at(answer, one.pointer);
    ASSERT_NE(error, nullptr) << one.path << " " << answer.outcome.body;
    EXPECT_EQ(text(*error, "code"), one.code) << one.path;
  }
}

TEST(FramePlates, AllMistakesAreToldAtOnce) {
  auto body = with(frame(), "plates/0/cutouts/0/shape", parsed(R"({"kind": "slot",
    "length_mm": 10, "width_mm": 20})"));
  body = with(body, "plates/1/outline/diameter_mm", 30.0);
  const auto answer = post(kFrames, body);
  EXPECT_NE(error_at(answer, "/plates/0/cutouts/0/shape/width_mm"), nullptr) << answer.outcome.body;
  EXPECT_NE(error_at(answer, "/joints/1"), nullptr) << answer.outcome.body;
}

/// A frame turned in plan and moved, its places with three decimals, and its lists the other way
/// round: as a model comes from a CAD system.
Json moved(Json frame, double turn) {
  const auto vector = [&](const std::vector<double>& v, bool place) {
    const double at[] = {std::cos(turn) * v[0] - std::sin(turn) * v[1] + (place ? 4016.8364 : 0.0),
                         std::sin(turn) * v[0] + std::cos(turn) * v[1] - (place ? 1247.6312 : 0.0),
                         v[2] + (place ? 310.5 : 0.0)};
    Json::Array out;
    for (const double one : at) out.emplace_back(place ? std::round(one * 1e3) / 1e3 : one);
    return Json{std::move(out)};
  };
  for (const auto* list : {"members", "plates"}) {
    if (frame.find(list) == nullptr) continue;
    const auto count = frame.find(list)->as<Json::Array>()->size();
    for (std::size_t i = 0; i < count; ++i)
      for (const auto* field : {"start_mm", "end_mm", "point_mm", "normal", "up"}) {
        const auto own = std::string(list) + "/" + std::to_string(i);
        if (at(frame, own).find(field) == nullptr) continue;
        const auto path = own + "/" + field;
        frame = with(frame, path, vector(numbers(frame, path), path.ends_with("_mm")));
      }
    auto rows = *frame.find(list)->as<Json::Array>();
    std::ranges::reverse(rows);
    frame = with(frame, list, Json{std::move(rows)});
  }
  return frame;
}

TEST(FramePlates, ATurnedModelInAnotherOrderHasTheSamePartsAndPlates) {
  for (const auto* file :
       {"frames/post-on-base-plate.json", "frames/sign-frame-with-tab-and-slot.json",
        "frames/shelf-arms-on-a-round-post.json"}) {
    const auto plain = post(kFrames, example(file)),
               turned = post(kFrames, moved(example(file), 0.39));
    ASSERT_FALSE(turned.outcome.error) << turned.outcome.body.substr(0, 800);
    EXPECT_EQ(text(turned.body, "verdict/status"), "ok") << file;
    for (const auto* total : {"made", "parts", "mass_kg", "blank_mm"})
      EXPECT_NEAR(number(turned.body, std::string("result/totals/") + total),
                  number(plain.body, std::string("result/totals/") + total), 0.05)
          << file << " " << total;
    const auto* plates = at(plain.body, "result").find("plates");
    if (plates == nullptr) continue;
    std::multiset<double> areas, others;
    for (const auto& one : *plates->as<Json::Array>()) areas.insert(number(one, "area_mm2"));
    for (const auto& one : *at(turned.body, "result/plates").as<Json::Array>())
      others.insert(number(one, "area_mm2"));
    ASSERT_EQ(areas.size(), others.size());
    for (auto a = areas.begin(), b = others.begin(); a != areas.end(); ++a, ++b)
      EXPECT_NEAR(*a, *b, 1e-3 * *a);
  }
}

/// An outline drawn in inches is that in mm, and a corner whose number cannot be read is refused at
/// the outline or at the opening, never read as 0.
TEST(FramePlates, ADrawnOutlineIsReadAsItIsDrawn) {
  const auto drawn = [](double unit, double width, double height, const std::string& last) {
    std::string text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n";
    text += unit == 1.0 ? "4" : "1";
    text += "\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n90\n4\n70\n1\n";
    const double x = 0.5 * width / unit, y = 0.5 * height / unit;
    const auto place = [](const std::string& a, double b) {
      return "10\n" + a + "\n20\n" + std::to_string(b) + "\n";
    };
    text += place(std::to_string(-x), -y) + place(std::to_string(x), -y) +
            place(std::to_string(x), y) + place(last.empty() ? std::to_string(-x) : last, y);
    return with(parsed(R"({"kind": "dxf"})"), "dxf", Json{text + "0\nENDSEC\n0\nEOF\n"});
  };
  const auto asked = [&](const Json& outline, const Json& window) {
    auto body = with(frame(), "plates/0/outline", outline);
    auto hole = with(parsed(R"({"id": "window", "at_mm": [70, 60]})"), "shape", window);
    return post(kFrames, with(body, "plates/0/cutouts", Json{Json::Array{hole}}));
  };
  for (const double unit : {1.0, 25.4}) {
    const auto answer = asked(drawn(unit, 203.2, 177.8, ""), drawn(unit, 25.4, 12.7, ""));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body;
    EXPECT_NEAR(number(answer.body, "result/plates/0/area_mm2"), 203.2 * 177.8 - 25.4 * 12.7, 1e-2);
    for (const char* last : {"-100,5", "-100.5mm", "abc", "1e400"}) {
      const auto outline = asked(drawn(unit, 203.2, 177.8, last), drawn(unit, 25.4, 12.7, ""));
      const auto* at_outline = error_at(outline, "/plates/0/outline/dxf");
      ASSERT_NE(at_outline, nullptr) << last << outline.outcome.body;
      EXPECT_EQ(text(*at_outline, "code"), "bad_text");
      const auto window = asked(drawn(unit, 203.2, 177.8, ""), drawn(unit, 25.4, 12.7, last));
      const auto* at_window = error_at(window, "/plates/0/cutouts/0/shape/dxf");
      ASSERT_NE(at_window, nullptr) << last << window.outcome.body;
      EXPECT_EQ(text(*at_window, "code"), "bad_text");
    }
  }
}

}  // namespace tubecut::testing::frame_plates
