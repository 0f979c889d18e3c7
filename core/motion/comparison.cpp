#include <algorithm>
#include <cmath>

#include "core/motion/course.hpp"
#include "core/motion/schedule.hpp"

namespace tubecut::motion {
namespace {

/// A segment of the polyline run at the asked speed with all axes linear between its ends.
struct Segment {
  double length = 0.0;     // mm of the tip's path
  double speed = 0.0;      // mm/s asked
  double axis_time = 0.0;  // s that the slowest axis needs at its largest speed
  double stop_time = 0.0;  // s from rest to rest, without a jerk limit
};

double rest_to_rest(double way, double v, double a) {
  return way * a >= v * v ? way / v + v / a : 2.0 * std::sqrt(way / a);
}

Segment segment(const Prepared& job, const std::vector<double>& s, std::size_t i) {
  const Coordinates from = coordinates_of(job.program, i), to = coordinates_of(job.program, i + 1);
  Segment out;
  out.length = tip_length(job.course.tip, job.program, i, i + 1);
  out.speed = job.course.speed.least(s[i], s[i + 1]);
  for (std::size_t a = 0; a < job.course.axes.size(); ++a) {
    const Axis& axis = job.course.machine.axes[a];
    const double way = std::abs(job.course.axes[a].at(to) - job.course.axes[a].at(from));
    const double v = velocity_limit(axis, job.course.machine.period);
    out.axis_time = std::max(out.axis_time, way / v);
    if (way > 0.0) out.stop_time = std::max(out.stop_time, rest_to_rest(way, v, axis.a_max));
  }
  return out;
}

}  // namespace

Comparison comparison(const Prepared& job, const std::stop_token& stop) {
  const std::vector<double> s = job.program.lengths();
  Comparison out;
  double share = 1.0;  // of the asked speed that the whole cut can keep
  for (std::size_t i = 0; i + 1 < job.program.size() && !stop.stop_requested(); ++i) {
    const Segment seg = segment(job, s, i);
    const double asked = seg.length / seg.speed;
    const bool slow = seg.axis_time > asked;
    out.slow_segments += slow ? 1 : 0;
    out.segments_time += std::max(asked, seg.axis_time);
    out.segments_stop_time += slow ? std::max(asked, seg.stop_time) : asked;
    if (slow) share = std::min(share, asked / seg.axis_time);
  }
  if (share > 0.0) {
    out.whole_cut_time = job.ideal / share;
    out.whole_cut_speed = job.length / out.whole_cut_time;
  }
  return out;
}

Naive naive_pulses(const Prepared& job, std::size_t a) {
  const Axis& axis = job.course.machine.axes[a];
  const std::vector<double> s = job.program.lengths();
  double peak = 0.0;
  Naive out;
  for (std::size_t i = 0; i + 1 < job.program.size(); ++i) {
    const double length = tip_length(job.course.tip, job.program, i, i + 1);
    if (length <= 0.0) continue;  // a pure swing has no time of its own to divide by
    const double step = job.course.speed.least(s[i], s[i + 1]) * job.course.machine.period;
    const double way = job.course.axes[a].at(coordinates_of(job.program, i + 1)) -
                       job.course.axes[a].at(coordinates_of(job.program, i));
    const double pulses = std::abs(way) * axis.pulses_per_axis_unit() * step / length;
    peak = std::max(peak, pulses);
    if (axis.n_max && pulses > static_cast<double>(*axis.n_max)) {
      out.periods_over += static_cast<std::int64_t>(std::ceil(length / step));
    }
  }
  out.peak = static_cast<std::int64_t>(std::floor(peak + 0.5));
  return out;
}

}  // namespace tubecut::motion
