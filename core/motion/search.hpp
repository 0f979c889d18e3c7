#pragma once

#include <functional>
#include <stop_token>

#include "core/motion/plan.hpp"

namespace tubecut::motion {

/// Length in periods of the filter with which `time_of` is least: every octave is tried, from the
/// longest that any axis can use down to one period.
[[nodiscard]] double best_octave(const Course& course,
                                 const std::function<double(double filter)>& time_of,
                                 const std::stop_token& stop);

/// Calls `lower(i)` for every interval that the filter window of sample `k` can reach.
void for_reach_of(const std::vector<Place>& places, std::size_t k, std::size_t reach,
                  std::size_t intervals, const std::function<void(std::size_t)>& lower);

/// The fastest plan by signed rows that is faster than `bound` seconds and whose samples hold every
/// limit of acceleration and jerk; empty x where none is found.
///
/// Source  docs/theory/pulse-schedules.md, section 6.3.
[[nodiscard]] Timing best_by_signed_rows(const Course& course, const Profile& without_jerk,
                                         HalfPlanes acceleration, double bound,
                                         const std::stop_token& stop);

}  // namespace tubecut::motion
