#pragma once

#include <cstddef>
#include <limits>
#include <stop_token>
#include <vector>

#include "core/bevel/smoothing.hpp"

/// The parts of `envelope`, for its two sources only: the braking sweeps, the rolling parabola and
/// their local updates.
namespace tubecut::bevel::detail {

/// The closed path and what its limits say about each node.
struct Turn {
  const std::vector<double>& s;
  const std::vector<double>& b;
  double period = 0.0;
  SwingLimits limits;
  double highest = 0.0;
  double steepest_start =
      0.0;  // min(K, A L / 4): a curve started no steeper has fallen below its start after one turn
  std::vector<double> ahead;  // mm from each node to the next
  std::vector<double> width;  // (h left + h right)/2
  std::vector<double> leave;  // m, start slope of each node's braking curves, rad/mm
  // The profile keeps the limits here. Such a node needs no curve of its own: where e is its B, e
  // at the neighbours is no lower than theirs, so e keeps the limits too.
  std::vector<char> quiet;
  std::vector<char> corner;  // concave beyond A: no start slope suits both sides
  // The node whose curve stands in for this one, or kNone: such a node starts no curves of its own.
  std::vector<std::size_t> under;
  std::vector<char> covers;  // some node lies under this one

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::size_t size() const { return b.size(); }
  [[nodiscard]] std::size_t next(std::size_t j) const { return j + 1 == size() ? 0 : j + 1; }
  [[nodiscard]] std::size_t previous(std::size_t j) const { return j == 0 ? size() - 1 : j - 1; }
  /// From i forward to k; a whole turn when they are equal.
  [[nodiscard]] double distance(std::size_t i, std::size_t k) const {
    return k > i ? s[k] - s[i] : s[k] - s[i] + period;
  }
  /// A curve that arrives at j with that value ends there, and j's own begins.
  [[nodiscard]] bool restarts(std::size_t j, double value) const {
    return under[j] == kNone && b[j] >= value;
  }
  /// Largest start slope whose curve stays below `highest` everywhere.
  [[nodiscard]] double start_bound(std::size_t j) const;
};
[[nodiscard]] Turn make_turn(const AngleProfile& profile, const EnvelopeSpec& spec);

/// A point on a braking curve, with its slope in the direction of travel.
struct Braking {
  double value = 0.0;
  double slope = 0.0;
  friend bool operator==(const Braking&, const Braking&) = default;
};
/// Nothing comes from a node that starts no curve.
inline constexpr Braking kNoCurve{-std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};
/// Travels h: the slope falls at the rate A down to -K. Exact integration.
[[nodiscard]] Braking brake(Braking from, double h, const SwingLimits& limits);

/// The two senses of travel.
enum class Sense { forward, backward };
[[nodiscard]] std::size_t step(const Turn& turn, std::size_t j, Sense sense);
/// Length of the step that arrives at j.
[[nodiscard]] double arriving(const Turn& turn, std::size_t j, Sense sense);
/// The start of node j's own curve.
[[nodiscard]] Braking start(const Turn& turn, std::size_t j, Sense sense);

/// Largest start slope of node j in that sense whose curve stays below `highest` at the nodes,
/// where alone f is defined: a little more than Turn::start_bound.
[[nodiscard]] double node_bound(const Turn& turn, std::size_t j, Sense sense);

struct Sweep {
  std::vector<double> value;
  std::vector<double> slope;    // in the direction of travel
  std::vector<char> restarted;  // value is B's own, the curve starts anew here
  bool closed = false;  // a second lap repeats the first; else value is the highest of several
};
[[nodiscard]] Sweep sweep(const Turn& turn, Sense sense);

/// The parabola of second derivative A through (i, e_i) and (k, e_k) passes below or through e_j, i
/// < j < k.
[[nodiscard]] bool touches(const Turn& turn, const std::vector<double>& e, std::size_t i,
                           std::size_t j, std::size_t k);
/// That parabola at j, never below e_j.
[[nodiscard]] double rolled(const Turn& turn, const std::vector<double>& e, std::size_t i,
                            std::size_t j, std::size_t k);

/// Everything `envelope` computes for one choice of start slopes.
struct Envelope {
  Sweep forward;
  Sweep backward;
  std::vector<double> e;                   // braking envelope: max of B and both sweeps
  std::vector<double> f;                   // the result
  std::vector<char> contact;               // f touches e
  std::vector<std::size_t> contact_after;  // at contacts only: the neighbouring contacts
  std::vector<std::size_t> contact_before;
  double area = 0.0;  // sum of (f - B) width; infinite when some e lies below B
};
[[nodiscard]] Envelope make_envelope(const Turn& turn);

/// The search has more than one valley, so it is begun twice: from the start slopes of single
/// corners searched first (as published), and from those of `make_turn`.
enum class Start { refined, plain };
/// Searches the start slopes of concave corners for least area, from a turn and its envelope;
/// changes turn.leave and turn.under. False when stopped.
[[nodiscard]] bool refine(Turn& turn, Envelope envelope, Start from, const std::stop_token& stop);

}  // namespace tubecut::bevel::detail
