#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/cutoff/rapid.hpp"
#include "core/cutoff/work_feed.hpp"

namespace tubecut::cutoff {

struct CycleSpec {
  double period = 0.002;                   // s, servo, > 0
  double max_cylinder_speed = 0.0;         // mm/s, > 0
  double max_cylinder_acceleration = 0.0;  // mm/s^2, > 0
  double max_cylinder_jerk = 0.0;          // mm/s^3, > 0
  std::optional<double> max_feed = {};     // mm, limit of the tool
  double dwell = 0.0;                      // s at the deepest point
  double handling = 0.0;                   // s a piece, outside the motion
  std::optional<double> target = {};       // requested pieces per hour, > 0
};

inline constexpr std::size_t kMostSamples = 2'000'000;

/// Set points at the servo period; the last one is exactly the end of the motion, at rest.
struct CycleSamples {
  std::vector<double> time;          // s
  std::vector<double> stroke;        // mm
  std::vector<double> speed;         // cylinder, mm/s
  std::vector<double> acceleration;  // cylinder, mm/s^2
  std::vector<double> feed;          // tool, mm
  std::vector<double> feed_speed;    // tool, mm/s
};

/// The feed that a target rate requires.
struct CycleTarget {
  bool met = false;
  std::optional<double> estimated_feed =
      {};  // mm/s, if the rapid moves keep their times; empty: they take longer than the target
  std::optional<double> feed =
      {};  // mm/s, if the ramps are planned again; empty: no feed within the limits
};

struct Cycle {
  double work_start = 0.0;  // t1, s
  double work_end = 0.0;    // t2, s
  double stop = 0.0;        // time until the tool stops, s
  double end = 0.0;         // t3, back at rest, s
  double cycle = 0.0;       // t3 + handling, s
  double pieces_per_hour = 0.0;
  std::optional<CycleTarget> target = {};
  double stop_feed = 0.0;    // tool at its deepest, mm
  double stop_stroke = 0.0;  // mm
  double overshoot = 0.0;    // tool beyond the work feed's end, mm
  double speed_in = 0.0;     // cylinder at the hand-over into the work feed, mm/s
  double speed_out = 0.0;
  double acceleration_step_in =
      0.0;  // magnitude, mm/s^2; the only steps of the cylinder's acceleration
  double acceleration_step_out = 0.0;
  double approach_peak = 0.0;  // mm/s
  double return_peak = 0.0;    // mm/s
  CycleSamples samples = {};
};

/// Computes rapid approach, work feed, stop, dwell and return within the cylinder's limits.
///
/// Errors    out_of_range, not_finite, work_speed_above_limit, work_accel_above_limit (also for the
///           jerk), approach_too_short, max_feed_exceeded, unreachable_x, too_many_samples,
///           cancelled.
/// Accuracy  strokes and speeds of neighbouring phases meet within 1e-11 mm and mm/s; the last
///           sample is exactly at rest.
/// Cost      one inverse or forward map a sample.
/// Source    docs/theory/feed-curves.md, section 5.
[[nodiscard]] Result<Cycle> cycle(const WorkFeed& work, const CycleSpec& spec);

}  // namespace tubecut::cutoff
