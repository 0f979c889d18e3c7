#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "core/motion/course.hpp"
#include "core/motion/reconstruction.hpp"

namespace tubecut::motion {

/// Counts under examination, one span per axis of the machine; empty where the axis stands.
struct Counted {
  double period = 0.0;
  std::size_t periods = 0;
  std::vector<std::span<const std::int32_t>> counts = {};
  std::vector<double> start = {};
};

/// The worst of several values, each against its own limit. Limits are positive or zero.
class Worst {
 public:
  void see(double value, double limit);
  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] Check check(std::string name, std::string unit) const {
    return {std::move(name), value_, limit_, std::move(unit)};
  }

 private:
  double value_ = 0.0;
  double limit_ = 0.0;
  bool any_ = false;
};

/// I2 to I9 and I16: sums, closure, limits per period, travel, reversals, the start. `jerk`: the
/// schedule claims a jerk limit.
[[nodiscard]] std::vector<Check> count_invariants(const Prepared& job, const Counted& counted,
                                                  bool jerk, const std::stop_token& stop);

struct Followed {
  std::vector<Check> checks = {};
  double deviation = 0.0;
};

/// I10 to I15 and, where a part border is given, `lead_clears_part`.
[[nodiscard]] Followed path_invariants(const ScheduleSpec& spec, const Prepared& job,
                                       const Counted& counted, bool with_lead,
                                       const std::stop_token& stop);

}  // namespace tubecut::motion
