#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace tubecut::api {

/// What makes jobs long: the CPU that one of them takes, and what it is counted by. One table:
/// `GET /v1/limits` shows it, `validate_only` and `over_budget` reckon by it. Measured by
/// `bench/estimates`, on one core of the machine in docs/promises.md. What grows worse than the
/// request does (pairs, triples, "for each") has a bound of its own in limits.hpp, but for the
/// pairs of points within a kerf, which the budget bounds.
/// X(name, seconds, per)
#define TUBECUT_COSTS(X)                                                                     \
  X(job, 0.5e-3, "job")                                                                      \
  X(body_byte, 60e-9, "byte of the body")                                                    \
  X(curve_point, 0.8e-6, "point of an intersection, on each wall")                           \
  X(curve_point_of_cutter, 0.03e-6, "point of an intersection, for each cutter")             \
  X(curve_cutter, 0.2e-3, "cutter of an intersection")                                       \
  X(table, 5e-3, "bevel table")                                                              \
  X(square_table, 0.7e-3, "bevel table of a plane square to its tube")                       \
  X(square_table_point, 3e-6, "point of a bevel table of a plane square to its tube")        \
  X(table_with_kerf, 10e-3, "bevel table with a kerf")                                       \
  X(table_point, 26e-6, "point of a bevel table")                                            \
  X(table_point_of_cutter, 0.3e-6, "point of a bevel table, for each cutter")                \
  X(beam_pair, 0.36e-6, "two points of a table or a hole no further apart than its kerf")    \
  X(rectangular_tube, 1.5e-3, "rectangular tube among the cutters")                          \
  X(elbow, 6e-3, "elbow among the cutters of a table or an intersection")                    \
  X(hole_point, 45e-6, "point of a hole")                                                    \
  X(member, 15e-6, "member of a node")                                                       \
  X(near_pair, 50e-6,                                                                        \
    "pair of members nearer than their radii of which neither cuts the other; not foreseen") \
  X(path, 4e-3, "pulse schedule")                                                            \
  X(path_knot, 13e-6, "0.1 mm of a schedule's path that bends or whose bevel changes")       \
  X(straight_knot, 2.5e-6, "0.1 mm of a schedule's path straight round its tube")            \
  X(contour_point, 100e-6, "point of a contour")                                             \
  X(axis_row, 10e-6, "row of axis columns")                                                  \
  X(period, 0.8e-6, "period of a schedule, or of a replay")                                  \
  X(feed_curve, 6e-3, "feed curve")                                                          \
  X(feed_row, 0.6e-6, "row of a feed curve's table")                                         \
  X(feed_sample, 0.07e-6, "servo sample of a cycle")                                         \
  X(feed_degree, 1.5e-3, "degree compared")                                                  \
  X(groove, 2e-3, "groove")                                                                  \
  X(groove_section, 4e-6, "section of a groove")                                             \
  X(normal_area, 0.08, "groove of equal normal sections")                                    \
  X(mill_path, 0.07, "mill path")                                                            \
  X(mill_position, 0.12e-3, "position of a mill path")                                       \
  X(mill_sample, 0.03e-6, "position, for each point of each ruling it is looked at by")      \
  X(mill_triple, 0.06e-6, "position, for each triple of a ruling's points")                  \
  X(annealed_sample, 7.5e-6, "position annealed, for each point of each ruling")

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
