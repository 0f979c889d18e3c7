#include "core/motion/slow.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr double kEndMargin = 2.0;  // mm where slow is just starting or stopping
constexpr double kSlow = 0.5;       // of the speed asked

/// Largest share of its limits that an axis uses over samples `from`..`to`; roots make the three
/// kinds comparable as speeds.
double share(const Course& course, const std::vector<Place>& places, std::size_t axis,
             std::size_t from, std::size_t to, const std::stop_token& stop) {
  const Axis& record = course.machine.axes[axis];
  const double t = course.machine.period;
  CourseCursor cursor(course);
  const auto at = [&](std::size_t k) {
    return course.axes[axis].at(cursor.at(places[std::min(k, places.size() - 1)]));
  };
  double speed = 0.0, acceleration = 0.0, jerk = 0.0;
  double a = at(from), b = at(from + 1), c = at(from + 2);
  for (std::size_t k = from + 3; k <= to + 3 && !stops(stop, k); ++k) {
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

std::string limiting_axis(const Course& course, const std::vector<Place>& places, std::size_t from,
                          std::size_t to, const std::stop_token& stop) {
  std::string name;
  double most = -1.0;
  for (const AxisBounds& bounds : course.limits.axes) {
    const double used = share(course, places, bounds.axis, from, to, stop);
    if (used > most) name = course.machine.axes[bounds.axis].name;
    most = std::max(most, used);
  }
  return name;
}

}  // namespace

std::vector<SlowZone> slow_zones(const Prepared& job, const std::vector<Place>& places,
                                 const std::stop_token& stop) {
  const Course& course = job.course;
  const double d = course.path.d, end = course.path.length() - kEndMargin;
  std::vector<SlowZone> out;
  bool inside = false;
  CourseCursor cursor(course);
  Pose at = cursor.at(places[0]);
  for (std::size_t k = 0; k + 1 < places.size() && !stops(stop, k); ++k) {
    const double from = places[k].u(d), to = places[k + 1].u(d);
    const Pose next = cursor.at(places[k + 1]);
    const double speed = tip_step(course, at, next) / course.machine.period;
    at = next;
    const bool slow =
        from >= kEndMargin && to <= end && speed < kSlow * course.speed.least(from, to);
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
    if (stop.stop_requested()) break;
    const auto from = static_cast<std::size_t>(zone.from), to = static_cast<std::size_t>(zone.to);
    zone.phi_from = course.path.at(places[from].interval, places[from].offset)[0];
    zone.phi_to = course.path.at(places[to + 1].interval, places[to + 1].offset)[0];
    zone.axis = limiting_axis(course, places, from, to, stop);
  }
  return out;
}

}  // namespace tubecut::motion
