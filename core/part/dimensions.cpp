#include "core/part/dimensions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/joint/joint.hpp"
#include "core/part/edge_mistakes.hpp"
#include "core/part/gauge.hpp"

namespace tubecut::part {
namespace {

constexpr double kSquare = 0.01;  // mm: a flatter end has no long point
constexpr std::size_t kMost = 12, kLeast = 8;
constexpr double kDiameterOff = 3.0;  // mm
constexpr double kClockingOff = 5.0 * kRadPerDeg;

double girth(const Shape& s) { return kTwoPi * s.outer_radius; }

using RoundGauge = Gauge<Shape>;

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

double chord(double radius, double phi_a, double z_a, double phi_b, double z_b) {
  return elementary::hypot(2.0 * radius * elementary::sin(0.5 * (phi_b - phi_a)), z_b - z_a);
}

double crown_chord(const Shape& s, bool finish) {
  const auto& e = outer(s, finish);
  const auto a = point(s, finish, true), b = point(s, finish, false);
  return chord(s.outer_radius, e.phi[a], e.z[a], e.phi[b], e.z[b]);
}

/// Returns the distance by which the inner edge extends beyond the outer one at phi.
double overhang(const Shape& s, bool finish, double phi) {
  const double ahead = outer(s, finish).at(phi).low - inner(s, finish).at(phi).low;
  return finish ? -ahead : ahead;
}

bool square(const Shape& s, bool finish) {
  const auto& e = outer(s, finish);
  return e.highest() - e.lowest() < kSquare;
}

double widest_overhang(const Shape& s, bool finish) {
  const auto& e = outer(s, finish);
  double best = 0.0, at = 0.0;
  for (const double phi : e.phi)
    if (const double here = std::abs(overhang(s, finish, phi)); here > best) {
      best = here;
      at = phi;
    }
  return at;
}

std::string called(bool finish) { return std::string(joint::end_name(finish)); }
std::string on_girth(const Shape& s, double phi) {
  return brief(std::round(10.0 * s.outer_radius * phi) / 10.0) +
         " mm round from the datum line, the way phi grows";
}

double tip_to_tip(const Shape& s) {
  return std::max(s.finish_outer.highest(), s.finish_inner.highest()) -
         std::min(s.start_outer.lowest(), s.start_inner.lowest());
}
double throat_to_throat(const Shape& s) {
  return std::min(s.finish_outer.lowest(), s.finish_inner.lowest()) -
         std::max(s.start_outer.highest(), s.start_inner.highest());
}

void add_lengths(std::vector<RoundGauge>& out) {
  for (const int deg : {0, 90, 180, 270}) {
    const std::string where =
        deg == 0 ? "on the datum line"
                 : "at " + std::to_string(deg / 90) + "/4 of the girth from the datum line";
    out.push_back(gauge<Shape>("length_at_" + std::to_string(deg), Tool::tape,
                               "start edge to finish edge along the outside, " + where,
                               [deg](const Shape& s) { return length_at(s, deg * kRadPerDeg); }));
  }
}

void add_end(const Shape& shape, bool finish, std::vector<RoundGauge>& out) {
  const auto end = called(finish);
  if (!square(shape, finish)) {
    out.push_back(gauge<Shape>(
        end + "_long_girth", Tool::wrap,
        "datum line to the " + end + "'s long point, round the outside, the way phi grows",
        [finish](const Shape& s) {
          return s.outer_radius * outer(s, finish).phi[point(s, finish, true)];
        },
        true));
    out.push_back(
        gauge<Shape>(end + "_crown_chord", Tool::rule,
                     "long point of the " + end + "'s outer edge straight to its short point",
                     [finish](const Shape& s) { return crown_chord(s, finish); }));
  }
  const double at = widest_overhang(shape, finish);
  if (std::abs(overhang(shape, finish, at)) < kSquare) return;
  out.push_back(
      gauge<Shape>(end + "_overhang", Tool::rule,
                   "outer edge of the " + end +
                       ", along the tube, to its inner edge: above zero where the inner edge "
                       "reaches further, below where it ends before, " +
                       on_girth(shape, at),
                   [finish, at](const Shape& s) { return overhang(s, finish, at); }));
}

/// Adds further dimensions while they fit: the tip, and for a single end its long and short points.
void add_more(const Shape& shape, std::vector<RoundGauge>& out) {
  if (out.size() < kMost)
    out.push_back(gauge<Shape>(
        "tip_to_tip", Tool::tape,
        "square laid on the start's tip to square on the finish's, along the tube", tip_to_tip));
  for (const bool finish : {false, true})
    for (const bool longest : {true, false}) {
      if (square(shape, finish) || out.size() >= kMost) continue;
      const std::string which = longest ? "_long" : "_short";
      out.push_back(gauge<Shape>("length_at_" + called(finish) + which, Tool::tape,
                                 called(finish) + "'s " + (longest ? "long" : "short") +
                                     " point to the other end along the outside",
                                 [finish, longest](const Shape& s) {
                                   return length_at(
                                       s, outer(s, finish).phi[point(s, finish, longest)]);
                                 }));
    }
  if (out.size() < kLeast)
    out.push_back(gauge<Shape>("throat_to_throat", Tool::tape,
                               "innermost point of the start to that of the finish, along the tube",
                               throat_to_throat));
}

std::vector<RoundGauge> gauges(const Shape& shape) {
  std::vector<RoundGauge> out;
  out.push_back(gauge<Shape>("girth", Tool::wrap, "round the outside", girth));
  add_lengths(out);
  for (const bool finish : {false, true}) add_end(shape, finish, out);
  out.push_back(gauge<Shape>("wall", Tool::caliper, "across the wall, square to it",
                             [](const Shape& s) { return s.wall; }));
  add_more(shape, out);
  return out;
}

EndEdges edges(Shape& s, bool finish) {
  return finish ? EndEdges{&s.finish_outer, &s.finish_inner}
                : EndEdges{&s.start_outer, &s.start_inner};
}

/// Returns the part with one mistake; for clocking and mirror, one shape for either end.
std::vector<Shape> with(Mistake mistake, const Shape& shape) {
  std::vector<Shape> out{shape};
  auto& s = out.front();
  const std::array ends{edges(s, false), edges(s, true)};
  switch (mistake) {
    case Mistake::diameter:
      s.outer_radius += 0.5 * kDiameterOff;
      break;
    case Mistake::wall:
      for (const auto& end : ends) thicken((s.wall + kWallOff) / s.wall, end);
      s.wall += kWallOff;
      break;
    case Mistake::clocking:
    case Mistake::mirror:
      out.push_back(shape);
      for (const bool finish : {false, true})
        move_end(edges(out[finish ? 1 : 0], finish), mistake == Mistake::mirror,
                 mistake == Mistake::clocking ? kClockingOff : 0.0);
      break;
    case Mistake::b_sign:
      swing_wrong(ends[0], s.start_root_outer);
      swing_wrong(ends[1], s.finish_root_outer);
      break;
    case Mistake::pivot_length:
      for (const auto& end : ends) shift_by_slope(kPivotOff / s.wall, end);
      break;
    case Mistake::height:
    case Mistake::width:
    case Mistake::swapped:
    case Mistake::quarter_turn:
    case Mistake::corner:
      return {};  // a round tube has no sides
  }
  return out;
}

}  // namespace

std::vector<CheckDimension> check_dimensions(const Shape& shape, const std::stop_token& stop) {
  return measured(gauges(shape), shape, kRoundMistakes, with, girth(shape), stop);
}

}  // namespace tubecut::part
