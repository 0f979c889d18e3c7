#pragma once

#include <string>
#include <vector>

#include "api/wire/format.hpp"
#include "core/motion/schedule/schedule.hpp"

namespace tubecut::api {

/// Returns the letter of each axis of a machine in RS-274: the first letter of its name if it is
/// free and of the right type (A B C rotate, X Y Z U V W are linear), else the next free one of its
/// type.
[[nodiscard]] std::vector<char> axis_letters(const std::vector<motion::AxisPulses>& axes);

/// Periods at which straight moves, uniform in time, begin and end so that every axis stays within
/// `tolerance` pulses of its counts at every period; the events' are among them. Ascending, from 0
/// to the last. Cost linear in the counts.
[[nodiscard]] std::vector<std::int64_t> move_ends(const motion::Schedule& schedule,
                                                  double tolerance);

/// Returns a schedule as RS-274 for LinuxCNC: the axes' own values at these periods, each move in
/// inverse time, so that the control keeps the planned times as well. The torch (of a cut along a
/// contour) is lit only by the option `torch`. `names`: names of a program's cuts for comments;
/// their periods at rest are dwells; empty for a single cut.
/// Accuracy  1 pulse at every period, 1e-6 of an axis' unit at the ends of moves.
[[nodiscard]] std::string print_schedule_gcode(const motion::Machine& machine,
                                               const motion::ScheduleSpec& spec,
                                               const motion::Schedule& schedule,
                                               const std::vector<std::string>& names,
                                               const Caption& caption);

}  // namespace tubecut::api
