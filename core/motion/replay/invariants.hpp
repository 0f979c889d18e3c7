#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/motion/path/course.hpp"
#include "core/motion/replay/reconstruction.hpp"

namespace tubecut::motion {

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

/// Checks I4 to I9, for any path: limits per period, travel, reversals. `jerk`: the schedule claims
/// a jerk limit.
///
/// Source  docs/theory/pulse-schedules.md, section 9.
[[nodiscard]] std::vector<Check> rate_invariants(const Machine& machine, const Counted& counted,
                                                 bool jerk);

/// Checks I2, I3 and I16: sums, closure, the start.
[[nodiscard]] std::vector<Check> place_invariants(const PreparedCut& job, const Counted& counted);

struct Followed {
  std::vector<Check> checks = {};
  double deviation = 0.0;
};

/// Checks I10 to I15 and, if `with_lead` is set for a closed cut, `lead_clears_part`.
///
/// Source  docs/theory/pulse-schedules.md, section 9.
[[nodiscard]] Followed path_invariants(const ScheduleSpec& spec, const PreparedCut& job,
                                       const Counted& counted, bool with_lead);

}  // namespace tubecut::motion
