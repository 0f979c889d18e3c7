#pragma once

#include <cstddef>

#include "core/base/stop.hpp"

namespace tubecut::api {

/// Thrown in the api if a job has to end; `dispatch` answers it by `over_budget`. In core, a
/// cancelled function returns early.
struct Stopped {};

inline void ask() {
  if (stopped()) throw Stopped{};
}

/// Checks for a stop now and then, for loops whose iterations take much less than a microsecond.
class Pace {
 public:
  void tick() {
    if (++ticks_ % kTicks == 0) ask();
  }

 private:
  static constexpr std::size_t kTicks = 1024;
  std::size_t ticks_ = 0;
};

}  // namespace tubecut::api
