#pragma once

#include <cstddef>
#include <stop_token>

namespace tubecut {

/// Asks in every 1024th turn, for loops whose turns take much less than a microsecond. `turn`
/// counts from 0: a loop that begins behind one that was stopped then does nothing, and what that
/// one left half made is not read.
[[nodiscard]] inline bool stops(const std::stop_token& stop, std::size_t turn) {
  return turn % 1024 == 0 && stop.stop_requested();
}

}  // namespace tubecut
