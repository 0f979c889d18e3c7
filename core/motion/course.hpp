#pragma once

#include <stop_token>

#include "core/motion/plan.hpp"
#include "core/motion/schedule.hpp"

namespace tubecut::motion {

/// A checked request, ready to be timed.
struct Prepared {
  Program program = {};
  Course course;
  double standoff_growth = 0.0;
  double ideal = 0.0;   // s, length over speed along the polyline
  double length = 0.0;  // mm of the tip's path along the polyline
};

/// Machine, program, speed and axes without the smoothed path: what a replay needs as well.
///
/// Errors  as `schedule`, except those of planning.
[[nodiscard]] Result<Prepared> prepared(const ScheduleSpec& spec, std::stop_token stop);

/// Tip path of the polyline between two of its points, mm.
[[nodiscard]] double tip_length(const std::vector<AxisFunction>& tip, const Program& program,
                                std::size_t from, std::size_t to);

/// Point `i` of the program.
[[nodiscard]] Coordinates coordinates_of(const Program& program, std::size_t i);

/// The comparison with slowing the whole cut and with slowing its segments.
///
/// Source  docs/theory/pulse-schedules.md, section 10.2.
[[nodiscard]] Comparison comparison(const Prepared& job, const std::stop_token& stop = {});

/// What running every segment of the polyline at the asked speed would ask of one axis.
struct Naive {
  std::int64_t peak = 0;          // pulses in a period, rounded
  std::int64_t periods_over = 0;  // periods above n_max
};
/// Source  docs/theory/pulse-schedules.md, section 10.1.
[[nodiscard]] Naive naive_pulses(const Prepared& job, std::size_t axis);

}  // namespace tubecut::motion
