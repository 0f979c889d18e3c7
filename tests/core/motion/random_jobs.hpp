#pragma once

#include <cstdint>
#include <random>

#include "core/motion/schedule/spec.hpp"

namespace tubecut::motion::testing {

/// Numbers that do not depend on the standard library's distributions.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double log_uniform(double low, double high);
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 engine_;
};

/// A hostile job: jumps and square waves of B, steps and kinks of z, limits scaled 0.1 to 5,
/// periods 0.2 to 10 ms, arms 0 to 300 mm, cutting speeds 2 to 25 mm/s (more only where a period of
/// 0.2 ms would make too many of them).
[[nodiscard]] ScheduleSpec random_job(std::uint64_t seed);

}  // namespace tubecut::motion::testing
