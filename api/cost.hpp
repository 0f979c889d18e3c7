#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace tubecut::api {

/// What makes jobs long: the CPU that one of them takes, and what it is counted by. One table:
/// `GET /v1/limits` shows it, `validate_only` and `over_budget` reckon by it. Measured by
/// `bench/estimates`, on one core of the machine in docs/promises.md. What grows worse than the
/// request does (pairs, triples, "for each") has a bound of its own in limits.hpp.
/// X(name, seconds, per)
#define TUBECUT_COSTS(X)                                                                     \
  X(job, 380e-6, "job")                                                                      \
  X(body_byte, 45e-9, "byte of the body")                                                    \
  X(curve_point, 600e-9, "point of an intersection, on each wall")                           \
  X(curve_point_of_cutter, 22e-9, "point of an intersection, for each cutter")               \
  X(curve_cutter, 150e-6, "cutter of an intersection")                                       \
  X(table, 3.8e-3, "bevel table")                                                            \
  X(square_table, 520e-6, "bevel table of a plane square to its tube")                       \
  X(square_table_point, 2.2e-6, "point of a bevel table of a plane square to its tube")      \
  X(table_with_kerf, 7.5e-3, "bevel table with a kerf")                                      \
  X(table_point, 20e-6, "point of a bevel table")                                            \
  X(table_point_of_cutter, 220e-9, "point of a bevel table, for each cutter")                \
  X(beam_pair, 270e-9, "two points of a table or a hole within its kerf of each other")      \
  X(rectangular_tube, 1.1e-3, "rectangular tube among the cutters")                          \
  X(elbow, 4.5e-3, "elbow among the cutters of a table or an intersection")                  \
  X(hole_point, 34e-6, "point of a hole")                                                    \
  X(member, 11e-6, "member of a node")                                                       \
  X(near_pair, 38e-6,                                                                        \
    "pair of members nearer than their radii of which neither cuts the other; not foreseen") \
  X(path, 3e-3, "pulse schedule")                                                            \
  X(path_knot, 9.8e-6, "0.1 mm of a schedule's path that bends or whose bevel changes")      \
  X(straight_knot, 1.9e-6, "0.1 mm of a schedule's path straight round its tube")            \
  X(contour_point, 75e-6, "point of a contour")                                              \
  X(axis_row, 7.5e-6, "row of axis columns")                                                 \
  X(period, 600e-9, "period of a schedule, or of a replay")                                  \
  X(feed_curve, 4.5e-3, "feed curve")                                                        \
  X(feed_row, 450e-9, "row of a feed curve's table")                                         \
  X(feed_sample, 52e-9, "servo sample of a cycle")                                           \
  X(feed_degree, 1.1e-3, "degree compared")                                                  \
  X(groove, 1.5e-3, "groove")                                                                \
  X(groove_section, 3e-6, "section of a groove")                                             \
  X(normal_area, 60e-3, "groove of equal normal sections")                                   \
  X(mill_path, 53e-3, "mill path")                                                           \
  X(mill_position, 90e-6, "position of a mill path")                                         \
  X(mill_sample, 22e-9, "position, for each point of each ruling it is looked at by")        \
  X(mill_triple, 45e-9, "position, for each triple of a ruling's points")                    \
  X(annealed_sample, 5.6e-6, "position annealed, for each point of each ruling")

enum class Cost {
#define X(name, seconds, per) name,
  TUBECUT_COSTS(X)
#undef X
};

struct CostInfo {
  std::string_view name;
  double seconds;
  std::string_view per;
};

inline constexpr auto kCosts = std::to_array<CostInfo>({
#define X(name, seconds, per) {#name, seconds, per},
    TUBECUT_COSTS(X)
#undef X
});

/// What a job has to do, counted before it is begun.
class Work {
 public:
  Work() { add(Cost::job); }
  void add(Cost cost, double count = 1.0) { counts_[static_cast<std::size_t>(cost)] += count; }
  [[nodiscard]] double of(Cost cost) const { return counts_[static_cast<std::size_t>(cost)]; }

  /// Seconds of CPU.
  [[nodiscard]] double seconds() const {
    double out = 0.0;
    for (std::size_t i = 0; i < kCosts.size(); ++i) out += counts_[i] * kCosts[i].seconds;
    return out;
  }

 private:
  std::array<double, kCosts.size()> counts_{};
};

}  // namespace tubecut::api
