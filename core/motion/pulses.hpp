#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/motion/machine.hpp"

namespace tubecut::motion {

/// Ideal cumulative pulses of an axis at value `q`, counted from `start`.
[[nodiscard]] double ideal_pulses(const Axis& axis, double q, double start);

/// floor(p + 1/2): halves go up on both signs. Never more than half a pulse off, and |N_k -
/// N_(k-1)| <= ceil|dp|.
///
/// Source  docs/theory/pulse-schedules.md, section 7.
[[nodiscard]] std::int64_t rounded(double pulses);

/// Signed pulses of every period from the cumulative ideal positions, the first of which is the
/// start.
[[nodiscard]] std::vector<std::int32_t> increments(std::span<const double> cumulative);

}  // namespace tubecut::motion
