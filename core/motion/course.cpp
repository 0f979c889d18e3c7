#include "core/motion/course.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/motion/soft_limits.hpp"

namespace tubecut::motion {
namespace {

/// Length over speed, segment by segment with the fastest speed of each: a floor for any schedule
/// of the polyline.
void measure(PreparedCut& job, const std::stop_token& stop) {
  const std::vector<double> s = job.program.lengths();
  for (std::size_t i = 1; i < job.program.size() && !stops(stop, i); ++i) {
    const double step = tip_length(job.course.tip, job.program, i - 1, i);
    job.length += step;
    job.ideal += step / job.course.speed.greatest(s[i - 1], s[i]);
  }
}

Result<void> check_periods(const PreparedCut& job, std::int64_t most) {
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

constexpr double kEndMargin = 2.0;  // mm at both ends where a slow tip is a start or stop
constexpr std::size_t kRest = 3;    // resting samples before and after

/// First, second and third difference of a value that is given sample by sample.
class Differences {
 public:
  explicit Differences(double start) : last_{start, start, start, start} {}
  void push(double value) { last_ = {last_[1], last_[2], last_[3], value}; }
  [[nodiscard]] double first() const { return last_[3] - last_[2]; }
  [[nodiscard]] double second() const { return (last_[3] - last_[2]) - (last_[2] - last_[1]); }
  [[nodiscard]] double third() const {
    return second() - ((last_[2] - last_[1]) - (last_[1] - last_[0]));
  }

 private:
  std::array<double, 4> last_;
};

/// Rounding of one axis value: a few units in the last place of its largest part.
double rounding(const Course& course, const AxisFunction& f) {
  double size =
      std::abs(f.constant) + std::abs(f.sin_b) + std::abs(f.cos_b) + 12.0 * std::abs(f.tan_b);
  for (std::size_t c = 0; c < course.path.control.size(); ++c) {
    if (f.linear[c] == 0.0) continue;
    const auto [low, high] = std::ranges::minmax(course.path.control[c]);
    size += std::abs(f.linear[c]) * std::max(std::abs(low), std::abs(high));
  }
  return 4.0 * 2.220446049250313e-16 * size;
}

/// One moving axis under watch.
struct Watched {
  const AxisFunction* function;
  const Axis* axis;
  Differences differences;
  double noise;
};

std::vector<Watched> watched(const Course& course) {
  const Pose start = CourseCursor(course).at({});
  std::vector<Watched> out;
  for (const AxisBounds& bounds : course.limits.axes) {
    const AxisFunction& f = course.axes[bounds.axis];
    out.push_back(
        {&f, &course.machine.axes[bounds.axis], Differences(f.at(start)), rounding(course, f)});
  }
  return out;
}

double over(double difference, double noise, double limit) {
  return std::max(0.0, std::abs(difference) - noise) / limit;
}

double jerk_ratio(const Watched& w, double period) {
  if (!w.axis->j_max) return 0.0;
  return over(w.differences.third(), 8.0 * w.noise, *w.axis->j_max * period * period * period);
}

double acceleration_ratio(const Watched& w, double period) {
  return over(w.differences.second(), 4.0 * w.noise, w.axis->a_max * period * period);
}

void note(const Watched& w, double period, bool jerk, AxisUse& use) {
  const double v = over(w.differences.first(), 2.0 * w.noise, w.axis->v_max * period);
  use.velocity = std::max(use.velocity, v);
  use.acceleration = std::max(use.acceleration, acceleration_ratio(w, period));
  if (jerk) use.jerk = std::max(use.jerk, jerk_ratio(w, period));
  if (w.axis->n_max) {
    const double pulses = std::abs(w.differences.first()) * w.axis->pulses_per_axis_unit();
    use.pulses = std::max(use.pulses, pulses / static_cast<double>(*w.axis->n_max));
  }
}

/// Calls `see(k)` after every sample, the resting ones behind the end included; k may pass the last
/// place.
template <class See>
void walk(const Course& course, const std::vector<Place>& places, std::vector<Watched>& axes,
          const std::stop_token& stop, const See& see) {
  CourseCursor cursor(course);
  for (std::size_t k = 0; k < places.size() + kRest && !stops(stop, k); ++k) {
    const Pose pose = cursor.at(places[std::min(k, places.size() - 1)]);
    for (Watched& w : axes) w.differences.push(w.function->at(pose));
    see(k);
  }
}

void note_tip(const Course& course, const std::vector<Place>& places, const std::stop_token& stop,
              Uses& out) {
  const double d = course.path.d, length = course.path.length(), period = course.machine.period;
  CourseCursor cursor(course);
  Pose from = cursor.at(places[0]);
  for (std::size_t k = 1; k < places.size() && !stops(stop, k); ++k) {
    const Pose to = cursor.at(places[k]);
    const double speed = tip_step(course, from, to) / period;
    const double start = places[k - 1].u(d), end = places[k].u(d);
    out.tip = std::max(out.tip, speed / course.speed.greatest(start, end));
    if (start >= kEndMargin && end <= length - kEndMargin) {
      out.least_tip = std::min(out.least_tip, speed);
    }
    from = to;
  }
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

Result<PreparedCut> prepare_cut(const ScheduleSpec& spec, std::stop_token stop) {
  if (auto ok = check(spec.machine); !ok) return passed_on(ok);
  auto axes = axis_functions(spec);
  if (!axes) return passed_on(axes);
  auto polyline = program(spec, stop);
  if (!polyline) return passed_on(polyline);
  const auto growth = standoff_growth(spec, *polyline);
  if (!growth) return passed_on(growth);
  auto speed = SpeedAlong::of(spec.motion.speed, *polyline);
  if (!speed) return passed_on(speed);
  PreparedCut job{
      std::move(*polyline),
      {{}, std::move(*axes), speed_functions(spec), std::move(*speed), {}, spec.machine},
      *growth};
  measure(job, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  if (auto ok = check_periods(job, spec.max_periods); !ok) return passed_on(ok);
  auto path = smooth_path(job.program, spec.motion.eps_tip, spec.motion.eps_b, stop);
  if (!path) return passed_on(path);
  Course& course = job.course;
  course.path = std::move(*path);
  if (auto ok = check_soft_limits(course.path, course.axes, course.machine,
                                  std::holds_alternative<CutPath>(spec.cut), stop);
      !ok) {
    return passed_on(ok);
  }
  course.limits =
      path_limits(course.path, course.axes, course.tip, course.speed, course.machine, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  return job;
}

bool Course::bends() const {
  const auto bent = [](const AxisFunction& f) { return !f.is_linear(); };
  return std::ranges::any_of(axes, bent) || std::ranges::any_of(tip, bent);
}

double tip_step(const Course& course, const Pose& from, const Pose& to) {
  double square = 0.0;
  for (const AxisFunction& f : course.tip) {
    const double step = f.at(to) - f.at(from);
    square += step * step;
  }
  return std::sqrt(square);
}

double Uses::worst() const {
  double most = tip;
  for (const AxisUse& use : axes) {
    most = std::max({most, use.velocity, use.acceleration, use.jerk, use.pulses});
  }
  return most;
}

Uses uses(const Course& course, const std::vector<Place>& places, bool jerk,
          const std::stop_token& stop) {
  Uses out;
  std::vector<Watched> axes = watched(course);
  out.axes.resize(axes.size());
  walk(course, places, axes, stop, [&](std::size_t) {
    for (std::size_t a = 0; a < axes.size(); ++a) {
      note(axes[a], course.machine.period, jerk, out.axes[a]);
    }
  });
  for (AxisUse& use : out.axes) {
    use.acceleration = std::sqrt(use.acceleration);
    use.jerk = elementary::cbrt(use.jerk);
  }
  note_tip(course, places, stop, out);
  return out;
}

Ratios ratios(const Course& course, const std::vector<Place>& places, const std::stop_token& stop) {
  Ratios out{std::vector<double>(places.size(), 0.0), std::vector<double>(places.size(), 0.0)};
  const double period = course.machine.period;
  std::vector<Watched> axes = watched(course);
  const auto note_at = [&](std::vector<double>& ratio, std::size_t k, double value) {
    double& at = ratio[std::min(k, places.size() - 1)];
    at = std::max(at, value);
  };
  walk(course, places, axes, stop, [&](std::size_t k) {
    double acceleration = 0.0, jerk = 0.0;
    for (const Watched& w : axes) {
      acceleration = std::max(acceleration, acceleration_ratio(w, period));
      jerk = std::max(jerk, jerk_ratio(w, period));
    }
    if (k >= 1) note_at(out.acceleration, k - 1, acceleration);
    if (k >= 1) note_at(out.jerk, k - 1, jerk);
    if (k >= 2) note_at(out.jerk, k - 2, jerk);
  });
  return out;
}

}  // namespace tubecut::motion
