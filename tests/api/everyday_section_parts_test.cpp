#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/call.hpp"
#include "tests/support/drawings.hpp"

/// Rectangular parts as a shop asks for them: sizes by name, in inches, with three decimals; every
/// pair of ends; the part begun from its other end, and turned by a quarter.
namespace tubecut::testing::everyday_section_parts {

constexpr const char* kParts = "/v1/parts";
using Random = std::mt19937;

api::Json parsed(const std::string& text) { return *api::parse(text); }

double between(Random& random, double from, double to) {
  // Three decimals, as a drawing states them.
  return std::round(1000.0 * std::uniform_real_distribution<double>(from, to)(random)) / 1000.0;
}

std::string text_of(double value) { return std::to_string(value); }

/// Height and width, and the rest of a target.
struct Size {
  double height, width;
  std::string rest;
};

Size drawn_size(Random& random) {
  switch (random() % 5) {
    case 0:  // 2 1/2 x 1 1/2 x 0.120 in
      return {63.5, 38.1,
              R"("kind": "rectangular_tube", "wall_mm": 3.048, "corners": "astm_a500")"};
    case 1:
      return {between(random, 40, 120), between(random, 40, 120),
              R"("kind": "rectangular_tube", "wall_mm": 2.951, "corner_radius_mm": 6.203)"};
    case 2:
      return {100, 50, R"("kind": "rectangular_tube", "wall_mm": 4, "corners": "en_10210")"};
    case 3:
      return {60, 60, R"("kind": "rectangular_tube", "wall_mm": 3, "corners": "en_10219")"};
    default:
      return {40, 90, R"("kind": "flat_oval_tube", "wall_mm": 3)"};
  }
}

/// A partner of an end in the end's own frame, turned about z by quarter turns.
struct Partner {
  enum class Kind { square, mitre_up, mitre_side, compound, saddle, stile };
  Kind kind = Kind::square;
  double a = 0.0, b = 0.0, size = 0.0;
};

Partner drawn_partner(Random& random, const Size& size) {
  Partner out{.kind = static_cast<Partner::Kind>(random() % 6)};
  out.a = between(random, -0.9, 0.9);
  out.b = between(random, -0.9, 0.9);
  out.size = std::round(1.3 * std::hypot(size.height, size.width));
  return out;
}

/// A vector in the plane across the tube, mirrored in y and turned from x towards y.
std::array<double, 2> laid(double x, double y, bool mirror, int quarters) {
  if (mirror) y = -y;
  for (int i = 0; i < quarters; ++i) {
    const double before = x;
    x = -y;
    y = before;
  }
  return {x, y};
}

std::string vector(const std::array<double, 2>& xy, double z) {
  return "[" + text_of(xy[0]) + ", " + text_of(xy[1]) + ", " + text_of(z) + "]";
}

std::string end_of(const Partner& p, bool mirror, int quarters) {
  const auto plane = [&](double x, double y) {
    return R"({"cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": )" +
           vector(laid(x, y, mirror, quarters), 1.0) + "}]}";
  };
  switch (p.kind) {
    case Partner::Kind::square:
      return R"({"square_at_mm": 5.125})";
    case Partner::Kind::mitre_up:
      return plane(1.0, 0.0);
    case Partner::Kind::mitre_side:
      return plane(0.0, -1.0);
    case Partner::Kind::compound:
      return plane(p.a, p.b);
    case Partner::Kind::saddle:
      return R"({"cutters": [{"kind": "tube", "outer_diameter_mm": )" + text_of(p.size) +
             R"(, "axis": {"point_mm": [0, 0, 0], "direction": )" +
             vector(laid(1.0, p.a, mirror, quarters), 0.4 * p.b) + "}}]}";
    case Partner::Kind::stile:
      return R"({"cutters": [{"kind": "rectangular_tube", "width_mm": )" + text_of(p.size) +
             R"(, "height_mm": )" + text_of(p.size) +
             R"(, "corner_radius_mm": 8, "axis": {"point_mm": [0, 0, 0], "direction": )" +
             vector(laid(0.0, 1.0, mirror, quarters), 0.3 * p.a) + R"(}, "up": )" +
             vector(laid(1.0, 0.0, mirror, quarters), 0.0) + "}]}";
  }
  return {};
}

api::Json part(const Size& size, double length, const Partner& start, const Partner& finish,
               bool mirror = false, int quarters = 0) {
  const bool across = quarters % 2 != 0;
  return parsed(R"({"preset": "tube_laser", "kerf_mm": 0.25, "sampling": {"tolerance_mm": 0.02},
                    "target": {"height_mm": )" +
                text_of(across ? size.width : size.height) + R"(, "width_mm": )" +
                text_of(across ? size.height : size.width) + ", " + size.rest +
                R"(, "length_mm": )" + text_of(length) + R"(}, "ends": {"start": )" +
                end_of(start, mirror, quarters) + R"(, "finish": )" +
                end_of(finish, mirror, mirror ? quarters : (4 - quarters) % 4) + "}}");
}

std::vector<double> faces(const Posted& answer) {
  return numbers(answer.body, "result/side_lengths/face_mm");
}

constexpr double kNear = 0.08;  // mm: both are within the tolerance, along a cut of 45 deg

TEST(EverydaySectionParts, AreMadeFromEitherEndInEveryFile) {
  Random random(23);
  for (int i = 0; i < drawings(16, 60); ++i) {
    const auto size = drawn_size(random);
    const auto start = drawn_partner(random, size), finish = drawn_partner(random, size);
    const double length = between(random, 700, 1500);
    const auto request = part(size, length, start, finish);
    SCOPED_TRACE(api::dump(request));
    const auto answer = post(kParts, request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
    // The same tube from its other end: faces 2 and 4 change places.
    const auto other = post(kParts, part(size, length, finish, start));
    ASSERT_FALSE(other.outcome.error) << other.outcome.body.substr(0, 600);
    const auto a = faces(answer), b = faces(other);
    for (const auto& [one, its] : {std::pair{0, 0}, {1, 3}, {2, 2}, {3, 1}})
      EXPECT_NEAR(a[static_cast<std::size_t>(one)], b[static_cast<std::size_t>(its)], kNear);
    EXPECT_NEAR(number(answer.body, "result/lengths/mass_kg"),
                number(other.body, "result/lengths/mass_kg"), 1e-3);
    for (const char* query :
         {"format=csv", "format=csv&view=check_dimensions", "format=svg", "format=nc1",
          "format=svg&view=template", "format=dxf", "format=dxf&view=tube", "format=pdf"})
      EXPECT_FALSE(post(kParts, std::string_view(api::dump(request)), query).outcome.error)
          << query;
  }
}

/// Height and width exchanged and everything turned by a quarter: each face has the numbers of the
/// one before it.
TEST(EverydaySectionParts, TurnedByAQuarterAreTheSame) {
  Random random(29);
  for (int i = 0; i < drawings(12, 40); ++i) {
    const auto size = drawn_size(random);
    const auto start = drawn_partner(random, size), finish = drawn_partner(random, size);
    const auto upright = part(size, 1000, start, finish),
               lying = part(size, 1000, start, finish, false, 1);
    SCOPED_TRACE(api::dump(lying));
    const auto a = post(kParts, upright), b = post(kParts, lying);
    ASSERT_FALSE(a.outcome.error) << a.outcome.body.substr(0, 600);
    ASSERT_FALSE(b.outcome.error) << b.outcome.body.substr(0, 600);
    const auto before = faces(a), after = faces(b);
    for (std::size_t face = 0; face < 4; ++face)
      EXPECT_NEAR(before[face], after[(face + 1) % 4], kNear);
    EXPECT_NEAR(number(a.body, "result/lengths/long_mm"), number(b.body, "result/lengths/long_mm"),
                kNear);
    EXPECT_NEAR(number(a.body, "result/lengths/mass_kg"), number(b.body, "result/lengths/mass_kg"),
                1e-3);
  }
}

/// The mirror image: faces 2 and 4 change places, and so do the corners beside them.
TEST(EverydaySectionParts, MirroredAreTheMirrorImage) {
  Random random(31);
  for (int i = 0; i < 40; ++i) {
    const auto size = drawn_size(random);
    const auto start = drawn_partner(random, size), finish = drawn_partner(random, size);
    const auto image = part(size, 1000, start, finish, true);
    SCOPED_TRACE(api::dump(image));
    const auto a = post(kParts, part(size, 1000, start, finish)), b = post(kParts, image);
    ASSERT_FALSE(a.outcome.error) << a.outcome.body.substr(0, 600);
    ASSERT_FALSE(b.outcome.error) << b.outcome.body.substr(0, 600);
    const auto face_a = faces(a), face_b = faces(b);
    const auto corner_a = numbers(a.body, "result/side_lengths/corner_mm");
    const auto corner_b = numbers(b.body, "result/side_lengths/corner_mm");
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(face_a[k], face_b[(4 - k) % 4], kNear);
      EXPECT_NEAR(corner_a[k], corner_b[3 - k], kNear);
    }
  }
}

/// Returns the largest turn of the tube between two cutting moves of a program, deg.
double largest_turn(const std::string& program) {
  std::istringstream lines(program);
  double most = 0.0, at = 0.0;
  for (std::string line; std::getline(lines, line);) {
    const auto word = line.find(" A");
    if (word == std::string::npos || line.front() != 'G') continue;
    const double to = std::stod(line.substr(word + 2));
    if (line.starts_with("G1")) most = std::max(most, std::abs(to - at));
    at = to;
  }
  return most;
}

/// Girth begins in the middle of face 1, where rounding decides on which side of it a point lies.
TEST(EverydaySectionParts, PathsAlongTheMiddleOfAFaceDoNotTurnTheTube) {
  const auto part = [](double kerf, const std::string& more) {
    return parsed(R"({"preset": "tube_laser", "kerf_mm": )" + std::to_string(kerf) +
                  R"(, "target": {"size": "SHS 100x100x4 EN 10219", "length_mm": 300},
          "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, )" +
                  more + "}");
  };
  const auto window = [](double offset) {
    return R"("cutouts": [{"id": "w", "shape": {"kind": "rectangle", "along_mm": 30,
              "round_mm": 16, "corner_radius_mm": 2}, "at": {"z_mm": 100, "face": 1,
              "offset_mm": )" +
           std::to_string(offset) + "}}]";
  };
  const auto letters = [](double angle) {
    return R"("texts": [{"id": "t", "at": {"z_mm": 100, "face": 1}, "text": "A", "height_mm": 8,
              "angle_deg": )" +
           std::to_string(angle) + "}]";
  };
  for (const auto& body : {part(0.0, window(8.0)), part(0.0, window(-8.0)), part(0.2, window(7.9)),
                           part(0.2, window(-7.9)), part(0.2, letters(90.0)),
                           part(0.2, letters(-90.0)), part(0.2, letters(45.0))}) {
    const auto text = api::dump(body);
    const auto answer = post(kParts, std::string_view(text),
                             "format=gcode&speed_mm_min=1200&lead_mm=2&marks=on"
                             "&mark_speed_mm_min=1200&pivot_length_mm=0");
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    EXPECT_LT(largest_turn(answer.outcome.body), 30.0) << text;
  }
}

/// Where one partner takes over from another the cut may step by tens of mm. Half a kerf from there
/// the beam's need steps as much, in gaps between rows that are 0.03 to 0.1 mm wide.
TEST(EverydaySectionParts, TheBeamSparesStepsBetweenTwoPartners) {
  const auto body = [](const char* target, const char* ends, const char* rest) {
    return parsed(std::string(R"({"preset": "tube_laser", "target": {"length_mm": 700, )") +
                  target + R"(}, "ends": {)" + ends + "}, " + rest + "}");
  };
  const auto square = R"("kind": "rectangular_tube", "height_mm": 50, "width_mm": 50, "wall_mm": 3,
                         "corner_radius_mm": 4.5)";
  const auto oval = R"("kind": "flat_oval_tube", "height_mm": 60, "width_mm": 30, "wall_mm": 3)";
  const auto box_and_plane = R"("finish": {"square_at_mm": 0}, "start": {"root_gap_mm": 2,
      "cutters": [{"kind": "rectangular_tube", "width_mm": 50.8, "height_mm": 80,
                   "corner_radius_mm": 6, "up": [0, 0, 1],
                   "axis": {"point_mm": [0, 10, 0], "direction": [1, 0, 0.9]}},
                  {"kind": "plane", "point_mm": [0, 10, 0], "normal": [-0.5, 0, 1]}]})";
  const auto tube_and_box = R"("start": {"square_at_mm": 0}, "finish": {"cutters": [
      {"kind": "tube", "outer_diameter_mm": 60.3,
       "axis": {"point_mm": [0, 10, -20], "direction": [0, 0.5, 0.3]}},
      {"kind": "rectangular_tube", "width_mm": 60, "height_mm": 60, "corner_radius_mm": 6,
       "axis": {"point_mm": [-8, 0, 10], "direction": [0, 1, -0.5]}, "up": [0, 1, 0.1]}]})";
  for (const char* kerf : {"0.2", "0.3", "1.5"})
    for (const char* tolerance : {"0.01", "0.02", "0.05"})
      for (const auto& [target, ends] :
           {std::pair{square, box_and_plane}, {oval, box_and_plane}, {oval, tube_and_box}}) {
        const auto rest = std::string(R"("kerf_mm": )") + kerf +
                          R"(, "sampling": {"tolerance_mm": )" + tolerance + "}";
        const auto answer = post(kParts, body(target, ends, rest.c_str()));
        ASSERT_FALSE(answer.outcome.error) << rest << ends << answer.outcome.body.substr(0, 400);
        EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
      }
}

/// A bare grid has no rows where a flat ends, so a gap of a hot-finished tube reaches from the flat
/// into the corner, where the wall is thicker.
TEST(EverydaySectionParts, TheBeamSparesGapsThatReachIntoAThickerCorner) {
  for (const char* points : {"36", "72", "100"})
    for (const char* kerf : {"0.3", "1.5"})
      for (const char* cut : {R"("groove": {"rule": "none"}, "root_surface": "outer",
                                 "contact": "outer")",
                              R"("groove": {"rule": "half_dihedral", "cap_deg": 40},
                                 "root_surface": "inner")"}) {
        const auto answer =
            post(kParts,
                 parsed(std::string(R"({"target": {"kind": "rectangular_tube", "height_mm": 41.991,
                "width_mm": 103.788, "wall_mm": 2.445, "corners": "en_10210", "length_mm": 1025},
                "ends": {"start": {"smoothing": {"method": "none"}, "cutters": [{"kind": "plane",
                "point_mm": [-6.351, 0, 3.905], "normal": [0.199, 0.466, 1]}], )") +
                        cut + R"(}, "finish": {"square_at_mm": 0}}, "kerf_mm": )" + kerf +
                        R"(, "sampling": {"uniform_points": )" + points + "}}"));
        EXPECT_FALSE(answer.outcome.error)
            << points << kerf << cut << answer.outcome.body.substr(0, 400);
      }
}

}  // namespace tubecut::testing::everyday_section_parts
