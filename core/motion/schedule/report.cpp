#include "core/motion/schedule/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/motion/schedule/schedule.hpp"
#include "core/motion/timing/plan.hpp"

namespace tubecut::motion {
namespace {

constexpr double kReportMargin =
    2.0;                       // mm at each end where a slow tip is only starting or stopping
constexpr double kSlow = 0.5;  // of the requested speed

/// Returns the largest fraction of its limits that an axis uses over samples `from`..`to`; roots
/// make the three kinds comparable as speeds.
double share(const Course& course, const std::vector<PathPosition>& positions, std::size_t axis,
             std::size_t from, std::size_t to) {
  const Axis& record = course.machine.axes[axis];
  const double t = course.machine.period;
  ValueCursor cursor(course.path, {&course.axes[axis], 1});
  const auto at = [&](std::size_t k) {
    return cursor.at(positions[std::min(k, positions.size() - 1)]).front();
  };
  double speed = 0.0, acceleration = 0.0, jerk = 0.0;
  double a = at(from), b = at(from + 1), c = at(from + 2);
  for (std::size_t k = from + 3; k <= to + 3 && !stops(k); ++k) {
    const double d = at(k);
    speed = std::max(speed, std::abs(d - c));
    acceleration = std::max(acceleration, std::abs(d - 2.0 * c + b));
    jerk = std::max(jerk, std::abs(d - 3.0 * c + 3.0 * b - a));
    a = b;
    b = c;
    c = d;
  }
  const double v = speed / (velocity_limit(record, t) * t);
  const double root = std::sqrt(acceleration / (record.a_max * t * t));
  const double cube = record.j_max ? elementary::cbrt(jerk / (*record.j_max * t * t * t)) : 0.0;
  return std::max({v, root, cube});
}

std::string limiting_axis(const Course& course, const std::vector<PathPosition>& positions,
                          std::size_t from, std::size_t to) {
  std::string name;
  double most = -1.0;
  for (const AxisBounds& bounds : course.limits.axes) {
    const double used = share(course, positions, bounds.axis, from, to);
    if (used > most) name = course.machine.axes[bounds.axis].name;
    most = std::max(most, used);
  }
  return name;
}

/// A segment of the polyline at the requested speed with all axes linear between its ends.
struct Segment {
  double length = 0.0;     // mm of the tip's path
  double speed = 0.0;      // mm/s requested
  double axis_time = 0.0;  // s of the slowest axis at its largest speed
  double stop_time = 0.0;  // s from rest to rest, without a jerk limit
};

double rest_to_rest(double way, double v, double a) {
  return way * a >= v * v ? way / v + v / a : 2.0 * std::sqrt(way / a);
}

Segment segment(const PreparedCut& job, const std::vector<double>& s, std::size_t i) {
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

void add_segment(const PreparedCut& job, std::size_t i, double length, double speed, Naive& out) {
  const Coordinates from = coordinates_of(job.program, i), to = coordinates_of(job.program, i + 1);
  const double period = job.course.machine.period;
  if (length > 0.0) out.time.push_back(out.time.back() + length / speed);
  for (std::size_t a = 0; a < out.axes.size(); ++a) {
    const Axis& axis = job.course.machine.axes[a];
    auto& of = out.axes[a];
    const double way = job.course.axes[a].at(to) - job.course.axes[a].at(from);
    const double step = way * axis.pulses_per_axis_unit();
    if (std::abs(step) > std::abs(static_cast<double>(of.largest_step)))
      of.largest_step = rounded(step);
    if (!(length > 0.0)) continue;
    const double pulses = std::abs(step) * speed * period / length;
    of.pulses.push_back(pulses);
    of.peak = std::max(of.peak, rounded(pulses));
    if (axis.n_max && pulses > static_cast<double>(*axis.n_max))
      *of.periods_over += static_cast<std::int64_t>(std::ceil(length / (speed * period)));
  }
}

std::vector<Use> largest_uses(const Course& course, const Plan& plan, bool jerk) {
  std::vector<Use> out;
  for (std::size_t i = 0; i < plan.uses.axes.size(); ++i) {
    const Axis& axis = course.machine.axes[course.limits.axes[i].axis];
    const AxisUse& use = plan.uses.axes[i];
    out.push_back({axis.name, 'v', use.velocity});
    out.push_back({axis.name, 'a', use.acceleration * use.acceleration});
    if (jerk && axis.j_max) out.push_back({axis.name, 'j', use.jerk * use.jerk * use.jerk});
    if (axis.n_max) out.push_back({axis.name, 'n', use.pulses});
  }
  return out;
}

/// Returns the pulses by which one revolution of a crawler differs from a whole count, because a
/// second lap must continue from the ideal position.
double closing_residual(const ScheduleSpec& spec) {
  const auto* const crawler = std::get_if<Crawler>(&spec.machine.kinematics);
  const auto* const cut_path = std::get_if<CutPath>(&spec.cut);
  if (crawler == nullptr || cut_path == nullptr || !cut_path->closed) return 0.0;
  const auto s = std::ranges::find(spec.machine.axes, "S", &Axis::name);
  const double turn =
      kTwoPi * (cut_path->outer_radius + crawler->wheel_offset) * s->pulses_per_unit;
  return turn - std::floor(turn);
}

}  // namespace

std::vector<SlowZone> slow_zones(const PreparedCut& job,
                                 const std::vector<PathPosition>& positions) {
  const Course& course = job.course;
  const double d = course.path.d, end = course.path.length() - kReportMargin;
  // If a lead meets the cut at a corner, the cut is just starting: a tab is broken off there.
  const auto first = job.program.cut_first;
  const bool turns_in = first > 0 && job.program.corner[first];
  const double begin = turns_in ? course.path.at_point[first] + kReportMargin : kReportMargin;
  std::vector<SlowZone> out;
  bool inside = false;
  TipCursor tip(course);
  tip.step_to(positions[0]);
  for (std::size_t k = 0; k + 1 < positions.size() && !stops(k); ++k) {
    const double from = positions[k].u(d), to = positions[k + 1].u(d);
    const double speed = tip.step_to(positions[k + 1]) / course.machine.period;
    const bool slow = from >= begin && to <= end && speed < kSlow * course.speed.least(from, to);
    const auto period = static_cast<std::int64_t>(k);
    if (slow && !inside) {
      out.push_back({period, period, 0.0, 0.0, speed, {}});
    } else if (slow) {
      out.back().to = period;
      out.back().least_speed = std::min(out.back().least_speed, speed);
    }
    inside = slow;
  }
  for (SlowZone& zone : out) {
    if (stopped()) break;
    const auto from = static_cast<std::size_t>(zone.from), to = static_cast<std::size_t>(zone.to);
    zone.phi_from = course.path.at(positions[from].interval, positions[from].offset)[0];
    zone.phi_to = course.path.at(positions[to + 1].interval, positions[to + 1].offset)[0];
    zone.axis = limiting_axis(course, positions, from, to);
  }
  return out;
}

std::int16_t NaiveAxis::step_in_16_bits() const {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(largest_step & 0xffff));
}

Comparison comparison(const PreparedCut& job) {
  const std::vector<double> s = job.program.lengths();
  Comparison out;
  out.naive.time.push_back(0.0);
  for (const auto& axis : job.course.machine.axes) {
    out.naive.axes.push_back({.name = axis.name});
    if (axis.n_max) out.naive.axes.back().periods_over = 0;
  }
  double share = 1.0;  // of the requested speed that the whole cut can keep
  for (std::size_t i = 0; i + 1 < job.program.size() && !stopped(); ++i) {
    const Segment seg = segment(job, s, i);
    const double asked = seg.length / seg.speed;
    add_segment(job, i, seg.length, seg.speed, out.naive);
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

Report report(const ScheduleSpec& spec, const PreparedCut& job, const Plan& plan) {
  const Path& path = job.course.path;
  Report out;
  out.time = static_cast<double>(plan.positions.size() - 1) * spec.machine.period;
  out.ideal = job.ideal;
  out.no_jerk = plan.no_jerk;
  out.optimality = out.time / plan.least;
  out.proven = plan.proven;
  out.filter = plan.timing.filter;
  out.stretch = plan.stretch;
  out.length = job.length;
  out.deviation_tip = path.deviation_tip;
  out.deviation_b = path.deviation_b;
  out.sag_tip = path.sag_tip;
  out.sag_b = path.sag_b;
  out.least_tip = plan.uses.least_tip < 1e300 ? plan.uses.least_tip : 0.0;
  out.standoff_growth = job.standoff_growth;
  out.closing_residual = closing_residual(spec);
  out.max_use = largest_uses(job.course, plan, spec.motion.jerk);
  const double fastest = job.course.speed.greatest(0.0, path.length());
  if (plan.uses.least_tip < kSlow * fastest) out.slow = slow_zones(job, plan.positions);
  out.slow_time = 0.0;
  for (const SlowZone& zone : out.slow) {
    out.slow_time += static_cast<double>(zone.to - zone.from + 1) * spec.machine.period;
  }
  return out;
}

}  // namespace tubecut::motion
