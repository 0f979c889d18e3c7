#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/joint/joint.hpp"
#include "core/part/edge_mistakes.hpp"
#include "core/part/gauge.hpp"

/// Dimensions and mistakes of the ends of any part: a shape `S` has the members start_outer,
/// start_inner, finish_outer, finish_inner, start_root_outer and finish_root_outer.
namespace tubecut::part {

inline constexpr double kSquare = 0.01;  // mm: a flatter end has no long point

template <class S>
[[nodiscard]] const Edge& outer(const S& s, bool finish) {
  return finish ? s.finish_outer : s.start_outer;
}
template <class S>
[[nodiscard]] const Edge& inner(const S& s, bool finish) {
  return finish ? s.finish_inner : s.start_inner;
}

/// Returns the node of the outer edge that is furthest from the other end (`longest`), or nearest
/// to it.
template <class S>
[[nodiscard]] std::size_t point(const S& s, bool finish, bool longest) {
  return outer(s, finish).extreme(finish == longest);
}

template <class S>
[[nodiscard]] double length_at(const S& s, double phi) {
  return s.finish_outer.at(phi).low - s.start_outer.at(phi).high;
}

template <class S>
[[nodiscard]] bool square(const S& s, bool finish) {
  const auto& e = outer(s, finish);
  return e.highest() - e.lowest() < kSquare;
}

/// Returns the distance by which the inner edge extends beyond the outer one at phi.
template <class S>
[[nodiscard]] double overhang(const S& s, bool finish, double phi) {
  const double ahead = outer(s, finish).at(phi).low - inner(s, finish).at(phi).low;
  return finish ? -ahead : ahead;
}

/// Returns the phi of the widest overhang.
template <class S>
[[nodiscard]] double widest_overhang(const S& s, bool finish) {
  double best = 0.0, at = 0.0;
  for (const double phi : outer(s, finish).phi)
    if (const double here = std::abs(overhang(s, finish, phi)); here > best) {
      best = here;
      at = phi;
    }
  return at;
}

/// How a kind of tube measures round its outside.
template <class S>
struct Round {
  double (*girth_at)(const S&, double phi);       // mm from the datum line
  double (*crown_chord)(const S&, bool finish);   // from the long point to the short one
  std::string (*on_girth)(const S&, double phi);  // a place, in words
  const char* way;                                // in which the girth is counted
};

/// Adds the dimensions of an end that is not square, and the overhang of its inner edge.
template <class S>
void add_end(const S& shape, bool finish, const Round<S>& round, std::vector<Gauge<S>>& out) {
  const std::string end(joint::end_name(finish));
  if (!square(shape, finish)) {
    out.push_back(gauge<S>(
        end + "_long_girth", Tool::wrap,
        "datum line to the " + end + "'s long point, round the outside, " + round.way,
        [finish, round](const S& s) {
          return round.girth_at(s, outer(s, finish).phi[point(s, finish, true)]);
        },
        true));
    out.push_back(gauge<S>(end + "_crown_chord", Tool::rule,
                           "long point of the " + end + "'s outer edge straight to its short point",
                           [finish, round](const S& s) { return round.crown_chord(s, finish); }));
  }
  const double at = widest_overhang(shape, finish);
  if (std::abs(overhang(shape, finish, at)) < kSquare) return;
  out.push_back(gauge<S>(end + "_overhang", Tool::rule,
                         "outer edge of the " + end +
                             ", along the tube, to its inner edge: above zero where the inner edge "
                             "reaches further, below where it ends before, " +
                             round.on_girth(shape, at),
                         [finish, at](const S& s) { return overhang(s, finish, at); }));
}

template <class S>
[[nodiscard]] EndEdges edges(S& s, bool finish) {
  return finish ? EndEdges{&s.finish_outer, &s.finish_inner}
                : EndEdges{&s.start_outer, &s.start_inner};
}

/// Returns a shape for either end, mirrored or turned by `by` (rad of the turn).
template <class S>
[[nodiscard]] std::vector<S> with_end_moved(const S& shape, bool mirror, double by) {
  std::vector<S> out{shape, shape};
  for (const bool finish : {false, true}) move_end(edges(out[finish ? 1 : 0], finish), mirror, by);
  return out;
}

/// Makes the wall thicker along the same torch lines; `wall` is the shape's own.
template <class S>
void thicken_wall(S& s, double& wall) {
  for (const bool finish : {false, true}) thicken((wall + kWallOff) / wall, edges(s, finish));
  wall += kWallOff;
}

/// B has the wrong sign at both ends.
template <class S>
void swing_both_wrong(S& s) {
  swing_wrong(edges(s, false), s.start_root_outer);
  swing_wrong(edges(s, true), s.finish_root_outer);
}

/// The pivot length is too long at both ends.
template <class S>
void lengthen_pivot(S& s, double wall) {
  for (const bool finish : {false, true}) shift_by_slope(kPivotOff / wall, edges(s, finish));
}

}  // namespace tubecut::part
