#pragma once

#include <cstddef>
#include <functional>

namespace tubecut {

/// An independent task, by its number.
using Turn = std::function<void(std::size_t)>;

/// Runs tasks 0 to count - 1 once each, in any order, possibly in parallel. Returns when all have
/// ended. Rethrows the exception of the lowest failed task. The caller of core chooses the threads;
/// the results do not depend on the choice.
using Turns = std::function<void(std::size_t count, const Turn& turn)>;

/// Runs the tasks one after the other.
inline void in_order(std::size_t count, const Turn& turn) {
  for (std::size_t i = 0; i < count; ++i) turn(i);
}

}  // namespace tubecut
