#include "core/part/dimensions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/joint/joint.hpp"
#include "core/part/end_gauges.hpp"

namespace tubecut::part {
namespace {

constexpr std::size_t kMost = 12, kLeast = 8;
constexpr double kDiameterOff = 3.0;  // mm
constexpr double kClockingOff = 5.0 * kRadPerDeg;

double girth(const Shape& s) { return kTwoPi * s.outer_radius; }

using RoundGauge = Gauge<Shape>;

double chord(double radius, double phi_a, double z_a, double phi_b, double z_b) {
  return elementary::hypot(2.0 * radius * elementary::sin(0.5 * (phi_b - phi_a)), z_b - z_a);
}

double crown_chord(const Shape& s, bool finish) {
  const auto& e = outer(s, finish);
  const auto a = point(s, finish, true), b = point(s, finish, false);
  return chord(s.outer_radius, e.phi[a], e.z[a], e.phi[b], e.z[b]);
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

constexpr Round<Shape> kRound{
    .girth_at = [](const Shape& s, double phi) { return s.outer_radius * phi; },
    .crown_chord = crown_chord,
    .on_girth = on_girth,
    .way = "the way phi grows"};

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
  for (const bool finish : {false, true}) add_end(shape, finish, kRound, out);
  out.push_back(gauge<Shape>("wall", Tool::caliper, "across the wall, square to it",
                             [](const Shape& s) { return s.wall; }));
  add_more(shape, out);
  return out;
}

/// Returns the part with one mistake; for clocking and mirror, one shape for either end.
std::vector<Shape> with(Mistake mistake, const Shape& shape) {
  std::vector<Shape> out{shape};
  auto& s = out.front();
  switch (mistake) {
    case Mistake::diameter:
      s.outer_radius += 0.5 * kDiameterOff;
      break;
    case Mistake::wall:
      thicken_wall(s, s.wall);
      break;
    case Mistake::clocking:
      return with_end_moved(shape, false, kClockingOff);
    case Mistake::mirror:
      return with_end_moved(shape, true, 0.0);
    case Mistake::b_sign:
      swing_both_wrong(s);
      break;
    case Mistake::pivot_length:
      lengthen_pivot(s, s.wall);
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

std::vector<CheckDimension> check_dimensions(const Shape& shape) {
  return measured(gauges(shape), shape, kRoundMistakes, with, girth(shape));
}

}  // namespace tubecut::part
