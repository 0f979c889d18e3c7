#pragma once

#include <string>

#include "api/wire/format.hpp"
#include "core/motion/schedule/schedule.hpp"

namespace tubecut::api {

/// One row per control period, one column of pulses per axis that moves.
[[nodiscard]] std::string schedule_csv(const motion::Schedule& schedule, const Caption& caption);

/// Pulses per period of every moving axis, and the tip's speed for cuts along a contour.
[[nodiscard]] std::string schedule_svg(const motion::ScheduleSpec& spec,
                                       const motion::Schedule& schedule, const Caption& caption);

}  // namespace tubecut::api
