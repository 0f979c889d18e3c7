#pragma once

#include <stop_token>
#include <vector>

#include "core/motion/course.hpp"

namespace tubecut::motion {

/// Runs of periods in which the tip goes slower than half of the speed asked, more than 2 mm from
/// both ends, each with the axis that uses most of one of its limits there. A slow tip burns the
/// edge: this is a defect, not just time.
///
/// Source  docs/theory/pulse-schedules.md, section 4.3.
[[nodiscard]] std::vector<SlowZone> slow_zones(const Prepared& job,
                                               const std::vector<Place>& places,
                                               const std::stop_token& stop = {});

}  // namespace tubecut::motion
