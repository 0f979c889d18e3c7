#pragma once

// Computes the pulses of every axis of a machine in every control period of a cut.
//
// Idea: the path has one parameter u, and the axes follow from it exactly. Limits and filters only
// change u(t), so timing cannot bend the cut, and rest is always feasible.
//
// Example: a wave around a tube of 100 mm on the first machine of the catalogue.
//     motion::CutPath wave;
//     wave.outer_radius = 50;
//     for (int i = 0; i < 360; ++i) {
//       wave.phi.push_back(i * kRadPerDeg);
//       wave.z.push_back(20 * elementary::sin(2 * i * kRadPerDeg));
//       wave.b.push_back(0);
//     }
//     motion::ScheduleSpec job;
//     job.cut = wave;
//     job.machine = motion::catalogue().front().machine;
//     const auto schedule = motion::schedule(job).value();
//     const double seconds = schedule.period * double(schedule.periods);  // 36.0

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/path/course.hpp"
#include "core/motion/schedule/report.hpp"
#include "core/motion/schedule/spec.hpp"
#include "core/motion/timing/plan.hpp"

namespace tubecut::motion {

/// Computes the ideal cumulative pulses of an axis at value `q`, counted from `start`.
[[nodiscard]] double ideal_pulses(const Axis& axis, double q, double start);

/// Returns floor(p + 1/2): halves round up for both signs. The error is at most half a pulse, and
/// |N_k - N_(k-1)| <= ceil|dp|.
///
/// Source  docs/theory/pulse-schedules.md, section 7.
[[nodiscard]] std::int64_t rounded(double pulses);

/// The pulses of one axis of the machine.
struct AxisPulses {
  std::string name = {};
  AxisUnit unit = AxisUnit::mm;
  double start = 0.0;                     // axis value before the first period, in its unit
  std::vector<std::int32_t> counts = {};  // one per period; empty: the axis never moves
  std::int64_t total = 0;
  std::int64_t peak = 0;  // largest |count|
  std::int64_t closure =
      0;  // pulses between end and start of a closed cut, modulo whole revolutions

  [[nodiscard]] bool idle() const { return counts.empty(); }
};

enum class EventKind : std::uint8_t {
  pierce,
  torch_on,
  pierce_end,  // of a dwell
  cut_start,
  cut_end,
  torch_off,
  rapid_start,
  rapid_end,
  mark_on,
  mark_off
};

struct Event {
  std::int64_t period = 0;  // periods done when the path has passed the mark
  EventKind what = EventKind::pierce;
  std::size_t cut = 0;  // of a program's cuts
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

/// A cut after timing, before its pulses are counted.
struct PlannedCut {
  PreparedCut job;
  Plan plan = {};
  std::vector<Event> events = {};
  Report report = {};
};

/// Errors  as `schedule`.
[[nodiscard]] Result<PlannedCut> plan_cut(const ScheduleSpec& spec);

/// Returns the warnings for a report.
[[nodiscard]] std::vector<Warning> warnings(const ScheduleSpec& spec, const Report& report);

/// Computes the pulses of every axis of the machine.
[[nodiscard]] std::vector<AxisPulses> pulses(const PreparedCut& job, const Plan& plan);

/// Computes integer pulses per axis and period for a cut on a machine: time-optimal without jerk
/// limits, jerk-limited, no pulse lost.
///
/// Errors    of the contour: bad_number, wrong_count, angle_out_of_range, duplicate_point,
///           turns_back, not_closed, out_of_range, unsupported_combination, lead_blocked,
///           speed_table_range; of the machine: zero_limit, bad_choice, soft_limit (axis, bound,
///           value, phi), standoff_too_large; too_many_periods (before memory is taken),
///           too_many_nodes, cancelled.
/// Accuracy  counts within half a pulse of the ideal at every period; ideal samples within every
///           limit to 1e-8.
/// Cost      about 40 sweeps over the knots (one every 0.1 mm) and 10 passes over the periods, of
///           some 20 ns each.
/// Source    docs/theory/pulse-schedules.md.
[[nodiscard]] Result<Schedule> schedule(const ScheduleSpec& spec);

}  // namespace tubecut::motion
