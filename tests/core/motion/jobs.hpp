#pragma once

#include <string_view>
#include <vector>

#include "api/wire/json.hpp"
#include "core/motion/schedule/schedule.hpp"

namespace tubecut::motion::testing {

inline constexpr double kFeed = 10.0;  // mm/s = 600 mm/min

/// The default machine of the spec, section 4.5, counting B as source 000 does (sigma = +1).
[[nodiscard]] Machine source_machine();
/// Table 1 of source 000 with a transition of 0, 10 or 20 points.
[[nodiscard]] ScheduleSpec table1(int transition_points, double speed = kFeed);
/// Its contour.
[[nodiscard]] CutPath& contour_of(ScheduleSpec& spec);
/// The golden file's case of that name.
[[nodiscard]] const api::Json& golden_case(std::string_view name);
/// A one-axis machine following z, and a straight line of `length` mm along z.
[[nodiscard]] ScheduleSpec straight_line(const Axis& axis, double length, double speed,
                                         double period);

/// The schedule, or a failed test and an empty one.
[[nodiscard]] Schedule planned(const ScheduleSpec& spec);
/// The first issue of a schedule that must be refused.
[[nodiscard]] Issue refusal(const ScheduleSpec& spec);
[[nodiscard]] const AxisPulses& axis(const Schedule& schedule, std::string_view name);

}  // namespace tubecut::motion::testing
