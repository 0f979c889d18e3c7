#pragma once

#include <cmath>

namespace tubecut {

/// Rounds a limit in mm or deg to three decimals, downwards or upwards, so that the number in the
/// message is accepted.
[[nodiscard]] inline double rounded_down(double limit) { return std::floor(limit * 1e3) / 1e3; }
[[nodiscard]] inline double rounded_up(double limit) { return std::ceil(limit * 1e3) / 1e3; }

}  // namespace tubecut
