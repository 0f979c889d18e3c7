#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/schedule/schedule.hpp"

namespace tubecut::motion {

/// For each axis, in the machine's order.
struct AxisSums {
  std::vector<std::int64_t> peak = {}, total = {};
};

/// Counts leg after leg, all rounded from one start: no pulse is lost between the legs, and no
/// error accumulates over all of them.
class PulseCounter {
 public:
  PulseCounter(const Machine& machine, std::vector<double> start);

  /// Reserves memory for this many further periods, because without it every count would be stored
  /// twice.
  void expect(std::int64_t periods);
  /// Adds one period that ends at these values of all axes.
  void step(const std::vector<double>& values);
  /// Adds periods at rest.
  void rest(std::int64_t periods);
  /// Adds the counts along a planned cut, from its start.
  void follow(const PlannedCut& cut);

  /// Returns the sums from this period on.
  [[nodiscard]] AxisSums sums_from(std::int64_t period) const;
  [[nodiscard]] std::int64_t periods() const { return periods_; }
  [[nodiscard]] const std::vector<double>& at() const { return at_; }
  /// Ends the counting and returns the pulses.
  [[nodiscard]] std::vector<AxisPulses> take();

 private:
  const Machine& machine_;
  std::vector<AxisPulses> axes_ = {};
  std::vector<double> at_;
  std::int64_t periods_ = 0;
};

}  // namespace tubecut::motion
