#pragma once

#include <cstddef>
#include <stop_token>

namespace tubecut {

/// Checks for cancellation in every 1024th iteration, for loops whose iterations take much less
/// than a microsecond. `turn` counts from 0, so a loop that follows a cancelled one does nothing,
/// and nobody reads the incomplete result.
[[nodiscard]] inline bool stops(const std::stop_token& stop, std::size_t turn) {
  return turn % 1024 == 0 && stop.stop_requested();
}

}  // namespace tubecut
