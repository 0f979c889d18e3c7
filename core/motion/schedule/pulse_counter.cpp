#include "core/motion/schedule/pulse_counter.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/base/stop.hpp"
#include "core/motion/schedule/value_cursor.hpp"

namespace tubecut::motion {

PulseCounter::PulseCounter(const Machine& machine, std::vector<double> start)
    : machine_(machine), at_(std::move(start)) {
  for (const Axis& axis : machine.axes)
    axes_.push_back({.name = axis.name, .unit = axis.unit, .start = at_[axes_.size()]});
}

void PulseCounter::expect(std::int64_t periods) {
  for (AxisPulses& axis : axes_)
    axis.counts.reserve(axis.counts.size() + static_cast<std::size_t>(periods));
}

void PulseCounter::step(const std::vector<double>& values) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    AxisPulses& axis = axes_[a];
    const std::int64_t now = rounded(ideal_pulses(machine_.axes[a], values[a], axis.start));
    axis.counts.push_back(static_cast<std::int32_t>(now - axis.total));
    axis.peak = std::max<std::int64_t>(axis.peak, std::abs(axis.counts.back()));
    axis.total = now;
  }
  at_ = values;
  ++periods_;
}

void PulseCounter::rest(std::int64_t periods) {
  expect(periods);
  for (AxisPulses& axis : axes_)
    axis.counts.resize(axis.counts.size() + static_cast<std::size_t>(periods), 0);
  periods_ += periods;
}

void PulseCounter::follow(const PlannedCut& cut) {
  ValueCursor cursor(cut.job.course.path, cut.job.course.axes);
  const auto& positions = cut.plan.positions;
  expect(static_cast<std::int64_t>(positions.size()) - 1);
  for (std::size_t k = 1; k < positions.size() && !stops(k); ++k) step(cursor.at(positions[k]));
}

AxisSums PulseCounter::sums_from(std::int64_t period) const {
  AxisSums out;
  for (const AxisPulses& axis : axes_) {
    std::int64_t peak = 0, sum = 0;
    for (auto k = static_cast<std::size_t>(period); k < axis.counts.size() && !stops(k); ++k) {
      const std::int64_t n = axis.counts[k];
      peak = std::max(peak, std::abs(n));
      sum += n;
    }
    out.peak.push_back(peak);
    out.total.push_back(sum);
  }
  return out;
}

std::vector<AxisPulses> PulseCounter::take() {
  for (AxisPulses& axis : axes_)
    if (axis.peak == 0) axis.counts = {};
  return std::move(axes_);
}

}  // namespace tubecut::motion
