// Cut-outs drawn as a DXF text are those of the same contour stated piece by piece, however a CAD
// program writes it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::dxf_cutouts {

using api::Json;
using Random = std::mt19937;

constexpr const char* kParts = "/v1/parts";

struct Point {
  double x = 0.0, y = 0.0;
};

/// A side of a rectangle, or the arc at its corner.
struct Side {
  Point from, to, centre;
  bool arc = false;
};

/// A window with four round corners, run counter-clockwise.
std::vector<Side> window(double width, double height, double radius) {
  const double x = 0.5 * width, y = 0.5 * height, r = radius;
  return {
      {{-x + r, -y}, {x - r, -y}, {}, false}, {{x - r, -y}, {x, -y + r}, {x - r, -y + r}, true},
      {{x, -y + r}, {x, y - r}, {}, false},   {{x, y - r}, {x - r, y}, {x - r, y - r}, true},
      {{x - r, y}, {-x + r, y}, {}, false},   {{-x + r, y}, {-x, y - r}, {-x + r, y - r}, true},
      {{-x, y - r}, {-x, -y + r}, {}, false}, {{-x, -y + r}, {-x + r, -y}, {-x + r, -y + r}, true}};
}

/// Groups of a DXF text, each of two lines.
class Dxf {
 public:
  Dxf(double unit, std::string end) : unit_(unit), end_(std::move(end)) {}

  void group(int code, const std::string& value) {
    text_ += "  " + std::to_string(code) + end_ + value + end_;
  }
  void number(int code, double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.8f", value);
    group(code, digits);
  }
  void point(int x, const Point& p) {
    number(x, p.x / unit_);
    number(x + 10, p.y / unit_);
  }
  [[nodiscard]] double length(double mm) const { return mm / unit_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  double unit_;
  std::string end_, text_;
};

void write_side(const Side& side, bool back, Dxf& out) {
  if (!side.arc) {
    out.group(0, "LINE");
    out.group(8, "CUT");
    out.point(10, back ? side.to : side.from);
    out.point(11, back ? side.from : side.to);
    return;
  }
  // Seen from behind, an arc is mirrored.
  const double flip = back ? -1.0 : 1.0;
  const auto angle = [&](const Point& p) {
    return std::atan2(p.y - side.centre.y, flip * (p.x - side.centre.x)) * kDegPerRad;
  };
  out.group(0, "ARC");
  out.point(10, {flip * side.centre.x, side.centre.y});
  out.number(40, out.length(std::hypot(side.from.x - side.centre.x, side.from.y - side.centre.y)));
  out.number(50, angle(back ? side.to : side.from));
  out.number(51, angle(back ? side.from : side.to));
  if (back) out.number(230, -1.0);
}

enum class Written { entities, light, old };

std::string dxf(const std::vector<Side>& sides, Written how, Random& random) {
  const bool inch = random() % 2 == 0;
  Dxf out(inch ? 25.4 : 1.0, random() % 2 == 0 ? "\n" : "\r\n");
  for (const auto& [code, value] :
       std::vector<std::pair<int, std::string>>{{0, "SECTION"}, {2, "HEADER"}, {9, "$INSUNITS"}})
    out.group(code, value);
  out.group(70, inch ? "1" : "4");
  out.group(0, "ENDSEC");
  out.group(0, "SECTION");
  out.group(2, "ENTITIES");
  if (how == Written::entities) {
    auto shuffled = sides;
    std::ranges::shuffle(shuffled, random);
    for (const auto& side : shuffled) write_side(side, random() % 2 == 0, out);
  } else {
    const bool light = how == Written::light;
    out.group(0, light ? "LWPOLYLINE" : "POLYLINE");
    if (light) out.group(90, std::to_string(sides.size()));
    out.group(70, "1");
    for (const auto& side : sides) {
      if (!light) out.group(0, "VERTEX");
      out.point(10, side.from);
      if (side.arc) out.number(42, std::tan(kPi / 8.0));
    }
    if (!light) out.group(0, "SEQEND");
  }
  out.group(0, "ENDSEC");
  out.group(0, "EOF");
  return out.text();
}

Json part_with(const Json& shape, double phi) {
  auto out = *api::parse(
      R"({"target": {"outer_diameter_mm": 114.3, "wall_mm": 5, "length_mm": 600}, "kerf_mm": 1.5,
          "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
          "cutouts": [{"id": "w", "at": {"z_mm": 300}}]})");
  out = with(out, "cutouts/0/at/phi_deg", phi);
  return with(out, "cutouts/0/shape", shape);
}

Json drawn(const std::string& text) {
  auto out = *api::parse(R"({"kind": "dxf"})");
  return with(out, "dxf", Json{text});
}

TEST(DxfCutouts, AreTheContourHoweverItIsWritten) {
  Random random(17);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<>(a, b)(random);
  };
  for (int drawing = 0; drawing < 30; ++drawing) {
    const auto how = static_cast<Written>(drawing % 3);
    const double width = between(20, 80), height = between(20, 60), radius = between(2, 9);
    const auto text = dxf(window(width, height, radius), how, random);
    auto plain = *api::parse(R"({"kind": "rectangle"})");
    plain = with(with(plain, "along_mm", width), "round_mm", height);
    plain = with(plain, "corner_radius_mm", radius);
    const auto wanted = post(kParts, part_with(plain, 40.0));
    const auto answer = post(kParts, part_with(drawn(text), 40.0));
    ASSERT_FALSE(wanted.outcome.error) << wanted.outcome.body.substr(0, 800);
    ASSERT_FALSE(answer.outcome.error) << text << answer.outcome.body.substr(0, 800);
    for (const char* name : {"area_outer_mm2", "volume_mm3", "instances/0/z_from_mm",
                             "instances/0/girth_from_mm", "instances/0/girth_to_mm"}) {
      const auto path = std::string("result/cutouts/0/") + name;
      EXPECT_NEAR(number(answer.body, path), number(wanted.body, path), 1e-4) << name << drawing;
    }
  }
}

/// A drawing with four decimals: its arcs meet its lines at small angles and small distances.
TEST(DxfCutouts, OfRoundedCoordinatesAreTaken) {
  std::string text = "0\nSECTION\n2\nENTITIES\n";
  const auto line = [&](const char* a, const char* b, const char* c, const char* d) {
    text += std::string("0\nLINE\n10\n") + a + "\n20\n" + b + "\n11\n" + c + "\n21\n" + d + "\n";
  };
  const auto arc = [&](const char* x, const char* y, const char* from, const char* to) {
    text += std::string("0\nARC\n10\n") + x + "\n20\n" + y + "\n40\n5.001\n50\n" + from + "\n51\n" +
            to + "\n";
  };
  line("-10.0003", "-15", "10", "-15.0002");
  arc("10", "-10", "270.01", "0");
  line("15", "-10", "15.001", "10");
  arc("10", "10", "0", "90");
  line("10", "15.001", "-10", "15");
  arc("-10", "10", "90", "180");
  line("-15", "10", "-15", "-10");
  arc("-10", "-10", "180", "270");
  text += "0\nENDSEC\n0\nEOF\n";
  const auto answer = post(kParts, part_with(drawn(text), 0.0));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(at(answer.body, "verification/passed"), Json{true});
}

TEST(DxfCutouts, EveryProblemIsAtTheText) {
  const std::string head = "0\nSECTION\n2\nENTITIES\n", tail = "0\nENDSEC\n0\nEOF\n";
  const std::string circle = "0\nCIRCLE\n10\n0\n20\n0\n40\n8\n";
  const auto refused = [&](const std::string& text, const char* code) {
    expect_refused(kParts, part_with(drawn(text), 0.0), "/cutouts/0/shape/dxf", code);
  };
  refused(head + "0\nLINE\n10\n0\n20\n0\n11\n20\n21\n0\n" + tail, "contour_open");
  refused(head + circle + "0\nCIRCLE\n10\n30\n20\n0\n40\n8\n" + tail, "out_of_range");
  refused(head + circle + "0\nSPLINE\n70\n8\n" + tail, "bad_choice");
  refused("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n2\n0\nENDSEC\n" + head + circle + tail,
          "bad_choice");
  refused(head + "0\nCIRCLE\n10\n0\n20\n0\n" + tail, "bad_text");
  refused(head + tail, "bad_text");
  refused("a drawing", "bad_text");
  const auto whole = post(kParts, part_with(drawn(head + circle + tail), 0.0));
  ASSERT_FALSE(whole.outcome.error) << whole.outcome.body.substr(0, 800);
  EXPECT_NEAR(number(whole.body, "result/cutouts/0/instances/0/z_from_mm"), 292.0, 1e-6);
}

/// Blank lines and the Ctrl-Z of DOS behind the end of a file say nothing; anything else is
/// refused.
TEST(DxfCutouts, EndAtTheirEof) {
  const std::string text =
      "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n10\n0\n20\n0\n40\n8\n0\nENDSEC\n0\nEOF";
  const auto whole = post(kParts, part_with(drawn(text), 0.0));
  ASSERT_FALSE(whole.outcome.error) << whole.outcome.body.substr(0, 800);
  for (const char* tail :
       {"\n", "\r\n", "\n\n", "\n\n\n", "\n \t\r\n", "\n\x1a", "\r\n\x1a\r\n\r\n"}) {
    const auto answer = post(kParts, part_with(drawn(text + tail), 0.0));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(at(answer.body, "job/result_sha256"), at(whole.body, "job/result_sha256"));
  }
  for (const char* tail : {"\nand more", "\n\nand more"})
    expect_refused(kParts, part_with(drawn(text + tail), 0.0), "/cutouts/0/shape/dxf", "bad_text");
}

/// A corner of a polyline is a place that the text states, never another: a number that cannot be
/// read, or none, is refused, and so is an entity that is not flat.
TEST(DxfCutouts, NoPlaceIsGuessed) {
  const auto polyline = [](bool light, const std::string& third) {
    std::string out = "0\nSECTION\n2\nENTITIES\n0\n";
    out += light ? "LWPOLYLINE\n70\n1\n" : "POLYLINE\n70\n1\n";
    for (const auto& place : {std::string("10\n0\n20\n0\n"), std::string("10\n20\n20\n0\n"), third,
                              std::string("10\n0\n20\n10\n")})
      out += (light ? "" : "0\nVERTEX\n") + place;
    return out + (light ? "" : "0\nSEQEND\n") + "0\nENDSEC\n0\nEOF\n";
  };
  for (const bool light : {true, false}) {
    for (const char* x : {"20,0", "20.0mm", "abc", "", "1.0D+1", "1e400", "20;", "nan"})
      expect_refused(kParts,
                     part_with(drawn(polyline(light, "10\n" + std::string(x) + "\n20\n10\n")), 0.0),
                     "/cutouts/0/shape/dxf", "bad_text");
    for (const char* place : {"10\n20\n", "20\n10\n", "10\n20\n20\n10\n42\n1,0\n"})
      expect_refused(kParts, part_with(drawn(polyline(light, place)), 0.0), "/cutouts/0/shape/dxf",
                     "bad_text");
    const auto whole = post(kParts, part_with(with(drawn(polyline(light, "10\n+20\n20\n10.0\n")),
                                                   "corners", Json{"as_cut"}),
                                              0.0));
    ASSERT_FALSE(whole.outcome.error) << whole.outcome.body.substr(0, 800);
    EXPECT_NEAR(number(whole.body, "result/cutouts/0/instances/0/z_to_mm") -
                    number(whole.body, "result/cutouts/0/instances/0/z_from_mm"),
                20.0, 1e-9);
  }
  const auto only = [](const std::string& entity) {
    return part_with(drawn("0\nSECTION\n2\nENTITIES\n" + entity + "0\nENDSEC\n0\nEOF\n"), 0.0);
  };
  const std::string circle = "0\nCIRCLE\n10\n0\n20\n0\n40\n8\n";
  const std::string field = "/cutouts/0/shape/dxf";
  for (const char* up : {"210\n0\n220\n1\n230\n0\n", "210\n0.8\n220\n0\n230\n0.6\n"})
    expect_refused(kParts, only(circle + up), field, "out_of_range");
  expect_refused(kParts, only(circle + "230\n-1,0\n"), field, "bad_text");
  expect_refused(kParts, only("0\nCIRCLE\n10\n0\n20\n0\n40\n-8\n"), field, "bad_text");
  expect_refused(kParts, only("0\nLINE\n10\n0\n20\n0\n30\n0\n11\n20\n21\n0\n31\n5\n"), field,
                 "out_of_range");
  // An angle that no turns lead down from, and what lies on the paper.
  expect_refused(kParts, only("0\nARC\n10\n0\n20\n0\n40\n8\n50\n1e300\n51\n0\n"), field,
                 "contour_open");
  const auto marked =
      post(kParts, part_with(drawn("\xEF\xBB\xBF"
                                   "0\nSECTION\n2\nENTITIES\n" +
                                   circle + "0\nVIEWPORT\n67\n1\n0\nENDSEC\n0\nEOF\n"),
                             0.0));
  EXPECT_FALSE(marked.outcome.error) << marked.outcome.body.substr(0, 800);
}

}  // namespace tubecut::testing::dxf_cutouts
