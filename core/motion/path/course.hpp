#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "core/motion/path/path_limits.hpp"
#include "core/motion/path/places.hpp"
#include "core/motion/schedule/value_cursor.hpp"

namespace tubecut::motion {

/// What a plan is measured against, and how its places become axis values.
struct Course {
  Path path = {};
  std::vector<AxisFunction> axes = {};  // all axes of the machine
  std::vector<AxisFunction> tip = {};
  SpeedAlong speed;
  PathLimits limits = {};
  Machine machine = {};
};

/// The way of the tip from one place to the next.
class TipCursor {
 public:
  explicit TipCursor(const Course& course);
  /// mm from the place before; the first step is from nowhere.
  double step_to(const Place& place);

 private:
  ValueCursor values_;
  std::vector<double> before_;
};

/// A checked request, ready to be timed.
struct PreparedCut {
  Program program = {};
  Course course;
  double standoff_growth = 0.0;
  double ideal = 0.0;   // s, length over speed along the polyline
  double length = 0.0;  // mm of the tip's path along the polyline
};

/// Machine, program, speed, axes, the smoothed path and its limits: what planning and a replay
/// start from.
///
/// Errors  as `schedule`, except those of planning.
[[nodiscard]] Result<PreparedCut> prepare_cut(const ScheduleSpec& spec, std::stop_token stop);

/// Tip path of the polyline between two of its points, mm.
[[nodiscard]] double tip_length(const std::vector<AxisFunction>& tip, const Program& program,
                                std::size_t from, std::size_t to);

/// Point `i` of the program.
[[nodiscard]] Coordinates coordinates_of(const Program& program, std::size_t i);

/// Share of each limit that the ideal samples use; 1 is the limit.
struct AxisUse {
  double velocity = 0.0;
  double acceleration = 0.0;  // square root of the ratio, so that a stretch of time divides it once
  double jerk = 0.0;          // cube root of the ratio
  double pulses = 0.0;        // of n_max
};
struct Uses {
  std::vector<AxisUse> axes = {};  // as PathLimits::axes
  double tip = 0.0;
  double least_tip = 1e300;  // mm/s, away from the ends; 1e300: nothing is away from them
  [[nodiscard]] double worst() const;
};

/// Differences of the axis values at the places, with three resting samples before and after,
/// against the limits. Rounding of the axis values themselves is allowed for.
///
/// Source  docs/theory/pulse-schedules.md, section 6.6.
[[nodiscard]] Uses uses(const Course& course, const std::vector<Place>& places, bool jerk,
                        const std::stop_token& stop = {});

/// Ratios of differences to their limits at every place, the worst of the axes; 0 where all hold.
struct Ratios {
  std::vector<double> acceleration = {};  // of the second difference that it is the middle of
  std::vector<double> jerk = {};          // of the third differences that it is a middle of
};
[[nodiscard]] Ratios ratios(const Course& course, const std::vector<Place>& places,
                            const std::stop_token& stop = {});

}  // namespace tubecut::motion
