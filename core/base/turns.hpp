#pragma once

#include <cstddef>
#include <functional>

namespace tubecut {

/// Pieces of one piece of work that know nothing of each other, by their numbers.
using Turn = std::function<void(std::size_t)>;

/// Does the turns 0 to count - 1, each once, in any order and perhaps some at a time, and is back
/// when all are done. What a turn throws comes out, of the least turn that threw. Who does them is
/// for whoever calls core to say: what they make is the same.
using Turns = std::function<void(std::size_t count, const Turn& turn)>;

/// One after the other.
inline void in_order(std::size_t count, const Turn& turn) {
  for (std::size_t i = 0; i < count; ++i) turn(i);
}

}  // namespace tubecut
