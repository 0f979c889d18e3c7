#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/motion/schedule/schedule.hpp"

namespace tubecut::motion {

/// Of each axis, in the machine's order.
struct AxisSums {
  std::vector<std::int64_t> peak = {}, total = {};
};

/// Counts leg after leg, each rounded from one start: no pulse is lost between the legs, and none
/// drifts over all of them.
class PulseCounter {
 public:
  PulseCounter(const Machine& machine, std::vector<double> start);

  /// Room for so many periods more: without, every count would be held twice.
  void expect(std::int64_t periods);
  /// One period later, at these values of all axes.
  void step(const std::vector<double>& values);
  /// So many periods at rest.
  void rest(std::int64_t periods);
  /// Along a planned cut, from where it begins.
  void follow(const PlannedCut& cut, const std::stop_token& stop);

  /// Of the periods from this one on.
  [[nodiscard]] AxisSums sums_from(std::int64_t period, const std::stop_token& stop) const;
  [[nodiscard]] std::int64_t periods() const { return periods_; }
  [[nodiscard]] const std::vector<double>& at() const { return at_; }
  /// Ends the counting.
  [[nodiscard]] std::vector<AxisPulses> take();

 private:
  const Machine& machine_;
  std::vector<AxisPulses> axes_ = {};
  std::vector<double> at_;
  std::int64_t periods_ = 0;
};

}  // namespace tubecut::motion
