#pragma once

#include <cstddef>
#include <vector>

#include "core/motion/path/path_limits.hpp"
#include "core/motion/path/path_positions.hpp"
#include "core/motion/schedule/value_cursor.hpp"

namespace tubecut::motion {

/// The limits and functions of a plan, and the map from its positions to axis values.
struct Course {
  Path path = {};
  std::vector<AxisFunction> axes = {};  // all axes of the machine
  std::vector<AxisFunction> tip = {};
  SpeedAlong speed;
  PathLimits limits = {};
  Machine machine = {};
};

/// The path of the tip from one position to the next.
class TipCursor {
 public:
  explicit TipCursor(const Course& course);
  /// Returns the distance in mm from the previous position; 0 for the first.
  double step_to(const PathPosition& position);

 private:
  ValueCursor values_;
  std::vector<double> before_;
};

/// A checked request, ready for timing.
struct PreparedCut {
  Program program = {};
  Course course;
  double standoff_growth = 0.0;
  double ideal = 0.0;   // s, length over speed along the polyline
  double length = 0.0;  // mm of the tip's path along the polyline
};

/// Prepares machine, program, speed, axes, the smoothed path and its limits: the input of planning
/// and of a replay.
///
/// Errors  as `schedule`, except those of planning.
[[nodiscard]] Result<PreparedCut> prepare_cut(const ScheduleSpec& spec);

/// Returns the tip path of the polyline between two of its points, mm.
[[nodiscard]] double tip_length(const std::vector<AxisFunction>& tip, const Program& program,
                                std::size_t from, std::size_t to);

/// Returns point `i` of the program.
[[nodiscard]] Coordinates coordinates_of(const Program& program, std::size_t i);
/// Returns the coordinates that a point of this path has in its program; `lean`: of the motion.
[[nodiscard]] Coordinates coordinates_of(const CutPath& path, Angle lean, const CutPoint& point);

/// The fraction of each limit that the ideal samples use; 1 is the limit.
struct AxisUse {
  double velocity = 0.0;
  double acceleration = 0.0;  // square root of the ratio, so that a stretch of time divides it once
  double jerk = 0.0;          // cube root of the ratio
  double pulses = 0.0;        // of n_max
};
struct Uses {
  std::vector<AxisUse> axes = {};  // as PathLimits::axes
  double tip = 0.0;
  double least_tip = 1e300;  // mm/s, away from the ends; 1e300: no sample is away from them
  [[nodiscard]] double worst() const;
};

/// Compares differences of the axis values at the positions, with three resting samples before and
/// after, with the limits. Permits the rounding of the axis values themselves.
///
/// Source  docs/theory/pulse-schedules.md, section 6.6.
[[nodiscard]] Uses uses(const Course& course, const std::vector<PathPosition>& positions,
                        bool jerk);

/// Ratios of differences to their limits at every position, the worst of the axes; 0 if all hold.
struct Ratios {
  std::vector<double> acceleration =
      {};                         // of the second difference with this position as its middle
  std::vector<double> jerk = {};  // of the third differences with this position in the middle
};
[[nodiscard]] Ratios ratios(const Course& course, const std::vector<PathPosition>& positions);

}  // namespace tubecut::motion
