#pragma once

#include <stop_token>
#include <vector>

#include "core/motion/timing.hpp"

namespace tubecut::motion {

/// What a plan is measured against, and how its places become axis values.
struct Course {
  Path path = {};
  std::vector<AxisFunction> axes = {};  // all axes of the machine
  std::vector<AxisFunction> tip = {};
  SpeedAlong speed;
  Limits limits = {};
  Machine machine = {};

  /// Some axis or the tip needs sin B and cos B.
  [[nodiscard]] bool bends() const;
};

/// Evaluates a course at its places, one after another.
class CourseCursor {
 public:
  explicit CourseCursor(const Course& course) : path_(course.path, course.bends()) {}
  [[nodiscard]] Pose at(const Place& place) { return path_.at(place.interval, place.offset); }

 private:
  PathCursor path_;
};

/// Way of the tip between two poses, mm.
[[nodiscard]] double tip_step(const Course& course, const Pose& from, const Pose& to);

/// Share of each limit that the ideal samples use; 1 is the limit.
struct AxisUse {
  double velocity = 0.0;
  double acceleration = 0.0;  // square root of the ratio, so that a stretch of time divides it once
  double jerk = 0.0;          // cube root of the ratio
  double pulses = 0.0;        // of n_max
};
struct Uses {
  std::vector<AxisUse> axes = {};  // as Limits::axes
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

/// Ratios of differences to their limits at every place, the worst of the axes.
struct Ratios {
  std::vector<double> acceleration = {};  // of the second difference that it is the middle of
  std::vector<double> jerk = {};          // of the third differences that it is a middle of
};
[[nodiscard]] Ratios ratios(const Course& course, const std::vector<Place>& places,
                            const std::stop_token& stop = {});

struct PlanOptions {
  bool jerk = true;
  double optimism = 3.0;
  std::optional<double> filter = {};  // s
  std::int64_t max_periods = 4'000'000;
};

struct Plan {
  Timing timing = {};
  double least = 0.0;    // s, no motion along the path within v, a, tip speed and n_max is faster
  double no_jerk = 0.0;  // s
  double proven = 0.0;   // s, of the proven mode
  double stretch = 1.0;
  std::vector<Place> places = {};
  Uses uses = {};
};

/// The fastest of the ladder of filters, with optimism and repair, never slower than the proven
/// mode; checked on its samples and, should a limit be broken there, stretched.
///
/// Where cancelling terms of acceleration bind, the plan by signed rows is made as well.
///
/// Errors  too_many_periods (before samples are taken), cancelled.
/// Source  docs/theory/pulse-schedules.md, sections 6.2 and 6.3.
[[nodiscard]] Result<Plan> plan(const Course& course, const PlanOptions& options,
                                std::stop_token stop);

/// Periods of `period` seconds that a time of `time` seconds takes.
[[nodiscard]] double periods_of(double time, double period);

}  // namespace tubecut::motion
