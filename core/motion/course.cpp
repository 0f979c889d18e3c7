#include "core/motion/course.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

Issue soft_limit(const Axis& axis, std::size_t index, bool upper, double value, double at,
                 bool contour) {
  const std::string where = contour ? " at phi " + std::to_string(at * kDegPerRad) + " deg" : "";
  return {ErrorCode::soft_limit,
          "machine/axes/" + std::to_string(index) + (upper ? "/soft_max" : "/soft_min"),
          value,
          upper ? *axis.soft_max : *axis.soft_min,
          std::string(name_of(axis.unit)),
          "axis " + axis.name + where};
}

/// Travel at every knot of the path against the soft limits: the farthest place outside each of
/// them.
Result<void> check_travel(const Course& course, bool contour, const std::stop_token& stop) {
  std::vector<Issue> issues;
  for (std::size_t a = 0; a < course.axes.size(); ++a) {
    const Axis& axis = course.machine.axes[a];
    for (const bool upper : {false, true}) {
      const auto& bound = upper ? axis.soft_max : axis.soft_min;
      if (!bound) continue;
      double worst = 0.0, value = 0.0, at = 0.0;
      for (std::size_t j = 0; j <= course.path.intervals() && !stops(stop, j); ++j) {
        const std::size_t i = j == course.path.intervals() ? j - 1 : j;
        const Coordinates x = course.path.at(i, j == i ? 0.0 : course.path.d);
        const double q = course.axes[a].at(x);
        const double beyond = upper ? q - *bound : *bound - q;
        if (beyond <= worst) continue;
        worst = beyond;
        value = q;
        at = x[0];
      }
      if (worst > 0.0) issues.push_back(soft_limit(axis, a, upper, value, at, contour));
    }
  }
  if (issues.empty()) return {};
  return tl::unexpected<Error>(Error{std::move(issues)});
}

/// Length over speed, segment by segment with the fastest speed of each: a floor for any schedule
/// of the polyline.
void measure(Prepared& job, const std::stop_token& stop) {
  const std::vector<double> s = job.program.lengths();
  for (std::size_t i = 1; i < job.program.size() && !stops(stop, i); ++i) {
    const double step = tip_length(job.course.tip, job.program, i - 1, i);
    job.length += step;
    job.ideal += step / job.course.speed.greatest(s[i - 1], s[i]);
  }
}

Result<void> check_periods(const Prepared& job, std::int64_t most) {
  // Smoothing shortens the polyline; half of it can never be gained.
  const double least = periods_of(0.5 * job.ideal, job.course.machine.period);
  if (least <= static_cast<double>(most)) return {};
  return fail({ErrorCode::too_many_periods,
               "motion",
               periods_of(job.ideal, job.course.machine.period),
               static_cast<double>(most),
               "periods",
               {}});
}

template <class T>
tl::unexpected<Error> passed_on(const Result<T>& result) {
  return tl::unexpected<Error>(result.error());
}

}  // namespace

Coordinates coordinates_of(const Program& program, std::size_t i) {
  Coordinates x{};
  for (std::size_t c = 0; c < program.x.size(); ++c) x[c] = program.x[c][i];
  return x;
}

double tip_length(const std::vector<AxisFunction>& tip, const Program& program, std::size_t from,
                  std::size_t to) {
  const Coordinates a = coordinates_of(program, from), b = coordinates_of(program, to);
  double square = 0.0;
  for (const AxisFunction& f : tip) {
    const double step = f.at(b) - f.at(a);
    square += step * step;
  }
  return std::sqrt(square);
}

Result<Prepared> prepared(const ScheduleSpec& spec, std::stop_token stop) {
  if (auto ok = check(spec.machine); !ok) return passed_on(ok);
  auto axes = axis_functions(spec);
  if (!axes) return passed_on(axes);
  auto polyline = program(spec, stop);
  if (!polyline) return passed_on(polyline);
  const auto growth = standoff_growth(spec, *polyline);
  if (!growth) return passed_on(growth);
  auto speed = SpeedAlong::of(spec.motion, *polyline);
  if (!speed) return passed_on(speed);
  Prepared job{std::move(*polyline),
               {{}, std::move(*axes), speed_functions(spec), std::move(*speed), {}, spec.machine},
               *growth};
  measure(job, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  if (auto ok = check_periods(job, spec.max_periods); !ok) return passed_on(ok);
  auto path = smooth_path(job.program, spec.motion.eps_tip, spec.motion.eps_b, stop);
  if (!path) return passed_on(path);
  Course& course = job.course;
  course.path = std::move(*path);
  if (auto ok = check_travel(course, std::holds_alternative<Contour>(spec.cut), stop); !ok) {
    return passed_on(ok);
  }
  course.limits = limits(course.path, course.axes, course.tip, course.speed, course.machine, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  return job;
}

}  // namespace tubecut::motion
