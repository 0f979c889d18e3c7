#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/motion/schedule/spec.hpp"

namespace tubecut::motion {

struct Path;
struct Place;
struct Plan;
struct PreparedCut;
struct Program;

/// Largest distance of the edges that a planned path cuts to those of its contour, whose points'
/// edges are joined straight in (phi, z) on each wall: smoothing and sag together, mm.
struct EdgeDeviation {
  double outer = 0.0;
  double inner = 0.0;
};

/// A run of periods with the tip below half of the speed asked, away from the ends.
struct SlowZone {
  std::int64_t from = 0;
  std::int64_t to = 0;    // last period of the run
  double phi_from = 0.0;  // rad; contour cuts only
  double phi_to = 0.0;
  double least_speed = 0.0;  // mm/s
  std::string axis = {};     // the axis nearest to a limit there
};

/// Share of a limit used: "v", "a", "j" or "n" of an axis; 1 is the limit.
struct Use {
  std::string axis = {};
  char limit = 'v';
  double share = 0.0;
};

/// What one axis is asked for when every segment of the contour is run at the speed asked.
struct NaiveAxis {
  std::string name = {};
  std::vector<double> pulses = {};                // per period, by segment
  std::int64_t peak = 0;                          // the most in a period, rounded
  std::optional<std::int64_t> periods_over = {};  // with more than n_max; empty: it has none
  std::int64_t largest_step = 0;                  // from one point to the next, signed

  /// The largest step as a register of 16 bits reads it.
  [[nodiscard]] std::int16_t step_in_16_bits() const;
};

/// Segment by segment at constant speed, from one point's axis values straight to the next's. A
/// segment along which the tip does not move has no time of its own and is left out.
struct Naive {
  std::vector<double> time = {};  // s at the ends of the segments, from 0
  std::vector<NaiveAxis> axes = {};
};

/// Of doing without a planner.
struct Comparison {
  double whole_cut_speed = 0.0;     // mm/s at which no axis breaks its speed anywhere
  double whole_cut_time = 0.0;      // s
  std::int64_t slow_segments = 0;   // contour segments that break an axis' speed at the speed asked
  double segments_time = 0.0;       // s, only these slowed; needs infinite acceleration
  double segments_stop_time = 0.0;  // s, these from rest to rest; no jerk limit
  Naive naive = {};
};

struct Report {
  double time = 0.0;        // s
  double ideal = 0.0;       // s, length over speed
  double no_jerk = 0.0;     // s, the fastest plan without jerk limits
  double optimality = 1.0;  // time over a bound below every plan, with jerk limits or without
  double proven = 0.0;      // s, of the plan that needs no check
  double filter = 0.0;      // s
  double stretch = 1.0;
  double length = 0.0;            // mm of the tip's path
  double deviation_tip = 0.0;     // mm, smoothing
  double deviation_b = 0.0;       // rad
  double sag_tip = 0.0;           // mm, curve between the contour's points
  double sag_b = 0.0;             // rad
  double least_tip = 0.0;         // mm/s, away from the ends
  double slow_time = 0.0;         // s below half of the speed asked
  double standoff_growth = 0.0;   // mm; crawler that swings about its pivot
  double closing_residual = 0.0;  // pulses by which a whole turn misses a whole count; crawler
  std::vector<Use> max_use = {};
  std::vector<SlowZone> slow = {};
  /// Of a contour.
  std::optional<EdgeDeviation> edges = {};
};

/// What a plan says of itself, its edges and comparison apart.
[[nodiscard]] Report report(const ScheduleSpec& spec, const PreparedCut& job, const Plan& plan,
                            const std::stop_token& stop);

/// Runs of periods in which the tip goes slower than half of the speed asked, more than 2 mm from
/// both ends, each with the axis that uses most of one of its limits there. A slow tip burns the
/// edge: this is a defect, not just time.
///
/// Source  docs/theory/pulse-schedules.md, section 4.3.
[[nodiscard]] std::vector<SlowZone> slow_zones(const PreparedCut& job,
                                               const std::vector<Place>& places,
                                               const std::stop_token& stop = {});

/// Of the cut between lead-in and lead-out; nothing of axis columns, which have no wall, and of a
/// cancelled call.
///
/// Accuracy  taken at the path's knots and three places between, 0.025 mm of generalised length
///           apart.
/// Cost      linear in the knots.
[[nodiscard]] std::optional<EdgeDeviation> edge_deviation(const ScheduleSpec& spec,
                                                          const Program& program, const Path& path,
                                                          const std::stop_token& stop);

/// The comparison with slowing the whole cut, with slowing its segments and with doing neither.
///
/// Cost    linear in the points of the contour.
/// Source  docs/theory/pulse-schedules.md, sections 10.1 and 10.2.
[[nodiscard]] Comparison comparison(const PreparedCut& job, const std::stop_token& stop = {});

}  // namespace tubecut::motion
