#include "core/motion/pulse_counter.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/base/stop.hpp"
#include "core/motion/value_cursor.hpp"

namespace tubecut::motion {

PulseCounter::PulseCounter(const Machine& machine, std::vector<double> start)
    : machine_(machine), at_(std::move(start)) {
  for (const Axis& axis : machine.axes)
    axes_.push_back({.name = axis.name, .unit = axis.unit, .start = at_[axes_.size()]});
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
  for (AxisPulses& axis : axes_)
    axis.counts.resize(axis.counts.size() + static_cast<std::size_t>(periods), 0);
  periods_ += periods;
}

void PulseCounter::follow(const PlannedCut& cut, const std::stop_token& stop) {
  ValueCursor cursor(cut.job.course.path, cut.job.course.axes);
  const auto& places = cut.plan.places;
  for (std::size_t k = 1; k < places.size() && !stops(stop, k); ++k) step(cursor.at(places[k]));
}

std::vector<AxisPulses> PulseCounter::take() {
  for (AxisPulses& axis : axes_)
    if (axis.peak == 0) axis.counts = {};
  return std::move(axes_);
}

}  // namespace tubecut::motion
