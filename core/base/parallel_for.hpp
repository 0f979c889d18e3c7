#pragma once

#include <cstddef>
#include <functional>

namespace tubecut {

/// An independent task, by its number.
using ParallelTask = std::function<void(std::size_t)>;

/// Runs tasks 0 to count - 1 once each, in any order, possibly in parallel. Returns when all have
/// ended. Rethrows the exception of the lowest failed task. The caller of core chooses the threads;
/// the results do not depend on the choice.
using ParallelFor = std::function<void(std::size_t count, const ParallelTask& task)>;

/// Runs the tasks one after the other.
inline void run_in_order(std::size_t count, const ParallelTask& task) {
  for (std::size_t i = 0; i < count; ++i) task(i);
}

}  // namespace tubecut
