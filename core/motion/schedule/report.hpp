#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/schedule/spec.hpp"

namespace tubecut::motion {

struct Path;
struct PathPosition;
struct Plan;
struct PreparedCut;
struct Program;

/// The largest distance of the edges that a planned path cuts to those of its contour, whose
/// points' edges are joined straight in (phi, z) on each wall: smoothing and sag together, mm. Of a
/// section in space, because its program has points enough; its inner edge is that of a wall as
/// thick as it is anywhere, so it deviates at most so much.
struct EdgeDeviation {
  double outer = 0.0;
  double inner = 0.0;
};

/// A run of periods with the tip below half of the requested speed, away from the ends.
struct SlowZone {
  std::int64_t from = 0;
  std::int64_t to = 0;    // last period of the run
  double phi_from = 0.0;  // rad; contour cuts only
  double phi_to = 0.0;
  double least_speed = 0.0;  // mm/s
  std::string axis = {};     // the axis nearest to a limit there
};

/// The used fraction of a limit: "v", "a", "j" or "n" of an axis; 1 is the limit.
struct Use {
  std::string axis = {};
  char limit = 'v';
  double share = 0.0;
};

/// The demand on one axis if every segment of the contour runs at the requested speed.
struct NaiveAxis {
  std::string name = {};
  std::vector<double> pulses = {};                // per period, by segment
  std::int64_t peak = 0;                          // maximum in a period, rounded
  std::optional<std::int64_t> periods_over = {};  // with more than n_max; empty: no n_max
  std::int64_t largest_step = 0;                  // from one point to the next, signed

  /// Returns the largest step as a register of 16 bits would store it.
  [[nodiscard]] std::int16_t step_in_16_bits() const;
};

/// Runs segment by segment at constant speed, from one point's axis values straight to the next's.
/// If the tip does not move along a segment, the segment has no time of its own and is omitted.
struct Naive {
  std::vector<double> time = {};  // s at the ends of the segments, from 0
  std::vector<NaiveAxis> axes = {};
};

/// Results without a planner.
struct Comparison {
  double whole_cut_speed = 0.0;  // mm/s at which no axis exceeds its speed anywhere
  double whole_cut_time = 0.0;   // s
  std::int64_t slow_segments =
      0;                       // contour segments that exceed an axis' speed at the requested speed
  double segments_time = 0.0;  // s, if only these are slowed; requires infinite acceleration
  double segments_stop_time = 0.0;  // s, if these run from rest to rest; no jerk limit
  Naive naive = {};
};

struct Report {
  double time = 0.0;        // s
  double ideal = 0.0;       // s, length over speed
  double no_jerk = 0.0;     // s, the fastest plan without jerk limits
  double optimality = 1.0;  // time over a lower bound of every plan, with jerk limits or without
  double proven = 0.0;      // s, of the plan that needs no check
  double filter = 0.0;      // s
  double stretch = 1.0;
  double length = 0.0;           // mm of the tip's path
  double deviation_tip = 0.0;    // mm, smoothing
  double deviation_b = 0.0;      // rad
  double sag_tip = 0.0;          // mm, curve between the contour's points
  double sag_b = 0.0;            // rad
  double least_tip = 0.0;        // mm/s, away from the ends
  double slow_time = 0.0;        // s below half of the requested speed
  double standoff_growth = 0.0;  // mm; crawler that swings about its pivot
  double closing_residual =
      0.0;  // pulses by which a whole revolution differs from a whole count; crawler
  std::vector<Use> max_use = {};
  std::vector<SlowZone> slow = {};
  /// Only for a section: the largest angle between the torch's plane and the normal, rad.
  std::optional<double> lean = {};
  /// Only for a contour.
  std::optional<EdgeDeviation> edges = {};
};

/// Returns the figures of a plan, except its edges and comparison.
[[nodiscard]] Report report(const ScheduleSpec& spec, const PreparedCut& job, const Plan& plan);

/// Finds the runs of periods in which the tip is slower than half of the requested speed, more than
/// 2 mm from both ends, each with the axis that uses most of one of its limits there. They are
/// reported because a slow tip burns the edge.
///
/// Source  docs/theory/pulse-schedules.md, section 4.3.
[[nodiscard]] std::vector<SlowZone> slow_zones(const PreparedCut& job,
                                               const std::vector<PathPosition>& positions);

/// Computes it for the cut between lead-in and lead-out. Empty for axis columns, because they have
/// no wall, and when cancelled.
///
/// Accuracy  taken at the path's knots and three positions between, 0.025 mm of generalised length
///           from each other.
/// Cost      linear in the knots.
[[nodiscard]] std::optional<EdgeDeviation> edge_deviation(const ScheduleSpec& spec,
                                                          const Program& program, const Path& path);

/// Returns the largest angle between the torch's plane and the normal of the outside at the tip,
/// rad: that of the blend, and what smoothing the tip adds. 0 if the tube is still, because the
/// plane then has the requested direction. Empty unless the cut is of a section.
///
/// Accuracy  taken at the path's knots.
[[nodiscard]] std::optional<double> largest_lean(const ScheduleSpec& spec, const Path& path);

/// Computes the times if the whole cut is slowed, if only its segments are slowed, and if neither
/// is.
///
/// Cost    linear in the points of the contour.
/// Source  docs/theory/pulse-schedules.md, sections 10.1 and 10.2.
[[nodiscard]] Comparison comparison(const PreparedCut& job);

}  // namespace tubecut::motion
