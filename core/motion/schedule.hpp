#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/motion/edges.hpp"
#include "core/motion/spec.hpp"

namespace tubecut::motion {

/// The pulses of one axis of the machine.
struct AxisPulses {
  std::string name = {};
  AxisUnit unit = AxisUnit::mm;
  double start = 0.0;                     // axis value before the first period, in its unit
  std::vector<std::int32_t> counts = {};  // one per period; empty: the axis never moves
  std::int64_t total = 0;
  std::int64_t peak = 0;     // largest |count|
  std::int64_t closure = 0;  // pulses between end and start of a closed cut, whole turns apart

  [[nodiscard]] bool idle() const { return counts.empty(); }
};

enum class EventKind : std::uint8_t { pierce, torch_on, cut_start, cut_end, torch_off };
[[nodiscard]] std::string_view name_of(EventKind kind);

struct Event {
  std::int64_t period = 0;  // periods done when the path has passed the mark
  EventKind what = EventKind::pierce;
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

/// Times of doing without a planner, for comparison.
struct Comparison {
  double whole_cut_speed = 0.0;     // mm/s at which no axis breaks its speed anywhere
  double whole_cut_time = 0.0;      // s
  std::int64_t slow_segments = 0;   // contour segments that break an axis' speed at the speed asked
  double segments_time = 0.0;       // s, only these slowed; needs infinite acceleration
  double segments_stop_time = 0.0;  // s, these from rest to rest; no jerk limit
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

struct Schedule {
  double period = 0.0;  // s
  std::int64_t periods = 0;
  std::vector<AxisPulses> axes = {};  // in the machine's order
  std::vector<Event> events = {};
  Report report = {};
  std::optional<Comparison> comparison = {};
  std::vector<Warning> warnings = {};
};

/// Integer pulses per axis and period for a cut on a machine: time-optimal without jerk limits,
/// jerk-limited, no pulse lost.
///
/// Errors    of the contour: bad_number, wrong_count, angle_out_of_range, duplicate_point,
/// not_closed, out_of_range,
///           unsupported_combination, lead_blocked, speed_table_range; of the machine: zero_limit,
///           bad_choice, soft_limit (axis, bound, value, phi), standoff_too_large; too_many_periods
///           (before memory is taken), too_many_nodes, cancelled.
/// Accuracy  counts within half a pulse of the ideal at every period; ideal samples within every
/// limit to 1e-8. Cost      about 10 to 20 sweeps over the knots (one every 0.1 mm), then one pass
/// over the periods. Source    docs/theory/pulse-schedules.md.
[[nodiscard]] Result<Schedule> schedule(const ScheduleSpec& spec, std::stop_token stop = {});

}  // namespace tubecut::motion
