#include <Eigen/Core>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/joint.hpp"
#include "core/part/edge_mistakes.hpp"
#include "core/part/gauge.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::part {
namespace {

using Shape = SectionShape;
using SectionGauge = Gauge<Shape>;

constexpr double kSquare = 0.01;                    // mm: a flatter end has no long point
constexpr double kSideOff = 3.0, kCornerOff = 2.0;  // mm
constexpr std::array kMistakes{Mistake::height, Mistake::width,  Mistake::swapped,
                               Mistake::corner, Mistake::wall,   Mistake::quarter_turn,
                               Mistake::mirror, Mistake::b_sign, Mistake::pivot_length};

double girth(const Shape& s) { return s.section.outer().girth(); }
const Edge& outer(const Shape& s, bool finish) { return finish ? s.finish_outer : s.start_outer; }
const Edge& inner(const Shape& s, bool finish) { return finish ? s.finish_inner : s.start_inner; }

/// Returns the node of the outer edge that is furthest from the other end (`longest`), or nearest
/// to it.
std::size_t point(const Shape& s, bool finish, bool longest) {
  return outer(s, finish).extreme(finish == longest);
}

double length_at(const Shape& s, double phi) {
  return s.finish_outer.at(phi).low - s.start_outer.at(phi).high;
}

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

/// Returns the distance by which the inner edge extends beyond the outer one.
double overhang(const Shape& s, bool finish, double phi) {
  const double ahead = outer(s, finish).at(phi).low - inner(s, finish).at(phi).low;
  return finish ? -ahead : ahead;
}

double widest_overhang(const Shape& s, bool finish) {
  double best = 0.0, at = 0.0;
  for (const double phi : outer(s, finish).phi)
    if (const double here = std::abs(overhang(s, finish, phi)); here > best) {
      best = here;
      at = phi;
    }
  return at;
}

/// Returns "62.5 mm round from the datum line, on face 2".
std::string on_girth(const Shape& s, double phi) {
  const auto at = s.section.outer().at(phi / kTwoPi * girth(s));
  return brief(std::round(10.0 * at.s) / 10.0) + " mm round from the datum line, on " +
         (at.on_corner ? "corner " : "face ") + std::to_string(at.face);
}

void add_end(const Shape& shape, bool finish, std::vector<SectionGauge>& out) {
  const std::string end(joint::end_name(finish));
  const auto& edge = outer(shape, finish);
  if (edge.highest() - edge.lowest() >= kSquare) {
    out.push_back(gauge<Shape>(
        end + "_long_girth", Tool::wrap,
        "datum line to the " + end + "'s long point, round the outside, towards face 2",
        [finish](const Shape& s) {
          return girth(s) / kTwoPi * outer(s, finish).phi[point(s, finish, true)];
        },
        true));
    out.push_back(
        gauge<Shape>(end + "_crown_chord", Tool::rule,
                     "long point of the " + end + "'s outer edge straight to its short point",
                     [finish](const Shape& s) { return crown_chord(s, finish); }));
  }
  const double at = widest_overhang(shape, finish);
  if (std::abs(overhang(shape, finish, at)) < kSquare) return;
  out.push_back(gauge<Shape>(
      end + "_overhang", Tool::rule,
      "outer edge of the " + end +
          ", along the tube, to its inner edge: above zero where the inner edge reaches further, "
          "below where it ends before, " +
          on_girth(shape, at),
      [finish, at](const Shape& s) { return overhang(s, finish, at); }));
}

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
  for (const bool finish : {false, true}) add_end(shape, finish, out);
  return out;
}

EndEdges edges(Shape& s, bool finish) {
  return finish ? EndEdges{&s.finish_outer, &s.finish_inner}
                : EndEdges{&s.start_outer, &s.start_inner};
}

/// Returns the part with one mistake; for mirror and quarter_turn, one shape for either end.
std::vector<Shape> with(Mistake mistake, const Shape& shape) {
  std::vector<Shape> out{shape};
  auto& s = out.front();
  auto& section = s.section;
  const std::array ends{edges(s, false), edges(s, true)};
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
      for (const auto& end : ends) thicken((section.wall + kWallOff) / section.wall, end);
      section.wall += kWallOff;
      break;
    case Mistake::quarter_turn:
      if (section.height != section.width) return {};  // the jaws do not hold it so
      [[fallthrough]];
    case Mistake::mirror:
      out.push_back(shape);
      for (const bool finish : {false, true})
        move_end(edges(out[finish ? 1 : 0], finish), mistake == Mistake::mirror,
                 mistake == Mistake::mirror ? 0.0 : 0.5 * kPi);
      break;
    case Mistake::b_sign:
      swing_wrong(ends[0], s.start_root_outer);
      swing_wrong(ends[1], s.finish_root_outer);
      break;
    case Mistake::pivot_length:
      for (const auto& end : ends) shift_by_slope(kPivotOff / section.wall, end);
      break;
    case Mistake::diameter:
    case Mistake::clocking:
      return {};  // of round tubes
  }
  return out;
}

}  // namespace

std::vector<CheckDimension> check_dimensions(const SectionShape& shape,
                                             const std::stop_token& stop) {
  return measured(gauges(shape), shape, kMistakes, with, girth(shape), stop);
}

}  // namespace tubecut::part
