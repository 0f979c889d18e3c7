#include <Eigen/Core>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/part/end_gauges.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::part {
namespace {

using Shape = SectionShape;
using SectionGauge = Gauge<Shape>;

constexpr double kSideOff = 3.0, kCornerOff = 2.0;  // mm
constexpr std::array kMistakes{Mistake::height, Mistake::width,  Mistake::swapped,
                               Mistake::corner, Mistake::wall,   Mistake::quarter_turn,
                               Mistake::mirror, Mistake::b_sign, Mistake::pivot_length};

double girth(const Shape& s) { return s.section.outer().girth(); }
/// A node of the outer edge in space.
Eigen::Vector3d place(const Shape& s, bool finish, std::size_t node) {
  const auto& e = outer(s, finish);
  const auto at = s.section.outer().at(e.phi[node] / kTwoPi * girth(s)).point;
  return {at.x(), at.y(), e.z[node]};
}

double crown_chord(const Shape& s, bool finish) {
  return (place(s, finish, point(s, finish, true)) - place(s, finish, point(s, finish, false)))
      .norm();
}

/// Returns "62.5 mm round from the datum line, on face 2".
std::string on_girth(const Shape& s, double phi) {
  const auto at = s.section.outer().at(phi / kTwoPi * girth(s));
  return brief(std::round(10.0 * at.s) / 10.0) + " mm round from the datum line, on " +
         (at.on_corner ? "corner " : "face ") + std::to_string(at.face);
}

constexpr Round<Shape> kRound{
    .girth_at = [](const Shape& s, double phi) { return girth(s) / kTwoPi * phi; },
    .crown_chord = crown_chord,
    .on_girth = on_girth,
    .way = "towards face 2"};

std::vector<SectionGauge> gauges(const Shape& shape) {
  std::vector<SectionGauge> out;
  out.push_back(gauge<Shape>("height", Tool::caliper, "face 1 to face 3, outside",
                             [](const Shape& s) { return s.section.height; }));
  out.push_back(gauge<Shape>("width", Tool::caliper, "face 2 to face 4, outside",
                             [](const Shape& s) { return s.section.width; }));
  out.push_back(gauge<Shape>("wall", Tool::caliper, "across the wall of a face, square to it",
                             [](const Shape& s) { return s.section.wall; }));
  out.push_back(gauge<Shape>("girth", Tool::wrap, "round the outside", girth));
  for (int face = 1; face <= 4; ++face) {
    const double phi = shape.section.outer().on_face(face, 0.0) / girth(shape) * kTwoPi;
    out.push_back(
        gauge<Shape>("length_on_face_" + std::to_string(face), Tool::tape,
                     "start edge to finish edge along the middle of face " + std::to_string(face),
                     [phi](const Shape& s) { return length_at(s, phi); }));
  }
  for (const bool finish : {false, true}) add_end(shape, finish, kRound, out);
  return out;
}

/// Returns the part with one mistake; for mirror and quarter_turn, one shape for either end.
std::vector<Shape> with(Mistake mistake, const Shape& shape) {
  std::vector<Shape> out{shape};
  auto& s = out.front();
  auto& section = s.section;
  switch (mistake) {
    case Mistake::height:
      section.height += kSideOff;
      break;
    case Mistake::width:
      section.width += kSideOff;
      break;
    case Mistake::swapped:
      std::swap(section.height, section.width);
      break;
    case Mistake::corner:
      section.corner =
          std::min(section.corner + kCornerOff, 0.5 * std::min(section.height, section.width));
      break;
    case Mistake::wall:
      thicken_wall(s, section.wall);
      break;
    case Mistake::quarter_turn:
      if (section.height != section.width) return {};  // the jaws do not hold it so
      return with_end_moved(shape, false, 0.5 * kPi);
    case Mistake::mirror:
      return with_end_moved(shape, true, 0.0);
    case Mistake::b_sign:
      swing_both_wrong(s);
      break;
    case Mistake::pivot_length:
      lengthen_pivot(s, section.wall);
      break;
    case Mistake::diameter:
    case Mistake::clocking:
      return {};  // of round tubes
  }
  return out;
}

}  // namespace

std::vector<CheckDimension> check_dimensions(const SectionShape& shape) {
  return measured(gauges(shape), shape, kMistakes, with, girth(shape));
}

}  // namespace tubecut::part
