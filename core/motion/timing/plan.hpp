#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/path/course.hpp"

namespace tubecut::motion {

struct PlanOptions {
  bool jerk = true;
  double optimism = 3.0;
  std::optional<double> filter = {};  // s
  std::int64_t max_periods = 4'000'000;
};

struct Plan {
  Timing timing = {};
  double least =
      0.0;  // s, lower bound for a motion along the path within v, a, tip speed and n_max
  double no_jerk = 0.0;  // s
  double proven = 0.0;   // s, of the proven mode
  double stretch = 1.0;
  std::vector<PathPosition> positions = {};
  Uses uses = {};
};

/// Returns the fastest plan of the ladder of filters, with optimism and repair, never slower than
/// the proven mode. Its samples are checked; if a limit is broken there, it is stretched.
///
/// If cancelling terms of acceleration bind, the plan by signed rows is computed as well.
///
/// Errors  too_many_periods (before samples are taken), cancelled.
/// Source  docs/theory/pulse-schedules.md, sections 6.2 and 6.3.
[[nodiscard]] Result<Plan> plan(const Course& course, const PlanOptions& options);

}  // namespace tubecut::motion
