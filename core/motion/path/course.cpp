#include "core/motion/path/course.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/machine/soft_limits.hpp"
#include "core/motion/path/upright.hpp"

namespace tubecut::motion {
namespace {

/// Computes length over speed, segment by segment with the fastest speed of each: a lower bound for
/// any schedule of the polyline.
void measure(PreparedCut& job) {
  const std::vector<double> s = job.program.lengths();
  for (std::size_t i = 1; i < job.program.size() && !stops(i); ++i) {
    const double step = tip_length(job.course.tip, job.program, i - 1, i);
    job.length += step;
    job.ideal += step / job.course.speed.greatest(s[i - 1], s[i]);
  }
}

Result<void> check_periods(const PreparedCut& job, std::int64_t most) {
  // Smoothing shortens the polyline by less than half.
  const double least = periods_of(0.5 * job.ideal, job.course.machine.period);
  if (least <= static_cast<double>(most)) return {};
  return too_many_periods(periods_of(job.ideal, job.course.machine.period), most);
}

constexpr double kEndMargin = 2.0;  // mm at both ends where a slow tip is a start or stop
constexpr std::size_t kRest = 3;    // resting samples before and after

/// First, second and third difference of a sampled value.
struct Differences {
  double value = 0.0;
  double first = 0.0, second = 0.0, third = 0.0;

  void push(double next) {
    const double one = next - value, two = one - first;
    third = two - second;
    second = two;
    first = one;
    value = next;
  }
};

/// Returns the rounding of one axis value: a few units in the last place of its largest part.
double rounding(const Course& course, const AxisFunction& f) {
  double size =
      std::abs(f.constant) + std::abs(f.sin_b) + std::abs(f.cos_b) + 12.0 * std::abs(f.tan_b);
  for (std::size_t c = 0; c < course.path.control.size(); ++c) {
    if (f.linear[c] == 0.0) continue;
    const auto [low, high] = std::ranges::minmax(course.path.control[c]);
    size += std::abs(f.linear[c]) * std::max(std::abs(low), std::abs(high));
  }
  if (f.turns()) {
    for (const std::size_t c : {3, 4}) {
      const auto [low, high] = std::ranges::minmax(course.path.control[c]);
      size +=
          2.0 * (std::abs(f.across) + std::abs(f.out)) * std::max(std::abs(low), std::abs(high));
    }
  }
  return 4.0 * 2.220446049250313e-16 * size;
}

/// The limits of one moving axis.
struct Watched {
  const Axis* axis;
  Differences differences;
  double noise;
  double velocity, acceleration, jerk;  // limits of the differences; 0: no limit
};

std::vector<AxisFunction> moving(const Course& course) {
  std::vector<AxisFunction> out;
  for (const AxisBounds& bounds : course.limits.axes) out.push_back(course.axes[bounds.axis]);
  return out;
}

std::vector<Watched> watched(const Course& course, const std::vector<double>& start) {
  const double t = course.machine.period;
  std::vector<Watched> out;
  for (const AxisBounds& bounds : course.limits.axes) {
    const Axis& axis = course.machine.axes[bounds.axis];
    out.push_back({&axis,
                   {start[out.size()]},
                   rounding(course, course.axes[bounds.axis]),
                   axis.v_max * t,
                   axis.a_max * t * t,
                   axis.j_max.value_or(0.0) * t * t * t});
  }
  return out;
}

double over(double difference, double noise, double limit) {
  return std::max(0.0, std::abs(difference) - noise) / limit;
}

/// Return the ratios of differences to their limits, 0 if those hold, because that avoids nearly
/// every division.
double jerk_excess(const Watched& w) {
  const double size = std::abs(w.differences.third), noise = 8.0 * w.noise;
  return w.jerk == 0.0 || size <= w.jerk + noise ? 0.0 : over(size, noise, w.jerk);
}

double acceleration_excess(const Watched& w) {
  const double size = std::abs(w.differences.second), noise = 4.0 * w.noise;
  return size <= w.acceleration + noise ? 0.0 : over(size, noise, w.acceleration);
}

/// Maxima of the magnitudes of differences.
struct Largest {
  double first = 0.0, second = 0.0, third = 0.0;

  void note(const Differences& d) {
    first = std::max(first, std::abs(d.first));
    second = std::max(second, std::abs(d.second));
    third = std::max(third, std::abs(d.third));
  }
};

/// Takes roots, so that a stretch of time divides each by the same factor.
AxisUse use_of(const Watched& w, const Largest& largest, bool jerk) {
  AxisUse out;
  out.velocity = over(largest.first, 2.0 * w.noise, w.velocity);
  out.acceleration = std::sqrt(over(largest.second, 4.0 * w.noise, w.acceleration));
  if (jerk && w.jerk > 0.0) {
    out.jerk = elementary::cbrt(over(largest.third, 8.0 * w.noise, w.jerk));
  }
  if (w.axis->n_max) {
    out.pulses =
        largest.first * w.axis->pulses_per_axis_unit() / static_cast<double>(*w.axis->n_max);
  }
  return out;
}

/// Returns the distance from `before` to `now`, and stores `now` in `before`.
double way_to(const double* now, std::vector<double>& before) {
  double square = 0.0;
  for (std::size_t f = 0; f < before.size(); ++f) {
    const double step = now[f] - before[f];
    square += step * step;
    before[f] = now[f];
  }
  return std::sqrt(square);
}

/// Calls `see(k, axes, values)` after every sample, including the resting ones after the end; k may
/// exceed the last position. The values are those of the moving axes, then of `beside`.
template <class See>
void walk(const Course& course, const std::vector<PathPosition>& positions,
          const std::vector<AxisFunction>& beside, const See& see) {
  std::vector<AxisFunction> functions = moving(course);
  functions.insert(functions.end(), beside.begin(), beside.end());
  ValueCursor cursor(course.path, functions);
  std::vector<Watched> axes = watched(course, cursor.at({}));
  for (std::size_t k = 0; k < positions.size() + kRest && !stops(k); ++k) {
    const auto& values = cursor.at(positions[std::min(k, positions.size() - 1)]);
    for (std::size_t a = 0; a < axes.size(); ++a) axes[a].differences.push(values[a]);
    see(k, axes, values);
  }
}

/// Records the tip's speed over the period that ends at position `k`.
void note_tip(const Course& course, const std::vector<PathPosition>& positions, std::size_t k,
              double step, Uses& out) {
  const double d = course.path.d, speed = step / course.machine.period;
  const double start = positions[k - 1].u(d), end = positions[k].u(d);
  out.tip = std::max(out.tip, speed / course.speed.greatest(start, end));
  if (start >= kEndMargin && end <= course.path.length() - kEndMargin) {
    out.least_tip = std::min(out.least_tip, speed);
  }
}

}  // namespace

Coordinates coordinates_of(const CutPath& path, Angle lean, const CutPoint& point) {
  Coordinates out{point.phi, point.z, point.b};
  if (!path.section) return out;
  const Upright up(*path.section, lean, path.still);
  const double s = path.outer_radius * point.phi;
  const auto tip = up.point(s);
  out[0] = up.angle(s);
  out[3] = tip.x();
  out[4] = tip.y();
  return out;
}

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

Result<PreparedCut> prepare_cut(const ScheduleSpec& spec) {
  TRY(check(spec.machine));
  TRY(auto axes, axis_functions(spec));
  TRY(auto polyline, program(spec));
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(const double growth, standoff_growth(spec, polyline));
  TRY(auto speed, SpeedAlong::of(spec.motion.speed, polyline));
  PreparedCut job{std::move(polyline),
                  {{}, std::move(axes), speed_functions(spec), std::move(speed), {}, spec.machine},
                  growth};
  measure(job);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(check_periods(job, spec.max_periods));
  Course& course = job.course;
  TRY(course.path, smooth_path(job.program, spec.motion.eps_tip, spec.motion.eps_b));
  const bool has_phi = std::holds_alternative<CutPath>(spec.cut);
  TRY(check_soft_limits(course.path, course.axes, course.machine, has_phi));
  course.limits = path_limits(course.path, course.axes, course.tip, course.speed, course.machine);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return job;
}

TipCursor::TipCursor(const Course& course)
    : values_(course.path, course.tip), before_(course.tip.size(), 0.0) {}

double TipCursor::step_to(const PathPosition& position) {
  return way_to(values_.at(position).data(), before_);
}

double Uses::worst() const {
  double most = tip;
  for (const AxisUse& use : axes) {
    most = std::max({most, use.velocity, use.acceleration, use.jerk, use.pulses});
  }
  return most;
}

Uses uses(const Course& course, const std::vector<PathPosition>& positions, bool jerk) {
  Uses out;
  std::vector<Largest> largest(course.limits.axes.size());
  std::vector<double> tip(course.tip.size());
  walk(course, positions, course.tip,
       [&](std::size_t k, const std::vector<Watched>& axes, const std::vector<double>& values) {
         for (std::size_t a = 0; a < axes.size(); ++a) largest[a].note(axes[a].differences);
         const double step = way_to(values.data() + axes.size(), tip);
         if (k > 0 && k < positions.size()) note_tip(course, positions, k, step, out);
       });
  const std::vector<Watched> axes = watched(course, std::vector<double>(largest.size()));
  for (std::size_t a = 0; a < axes.size(); ++a) {
    out.axes.push_back(use_of(axes[a], largest[a], jerk));
  }
  return out;
}

Ratios ratios(const Course& course, const std::vector<PathPosition>& positions) {
  Ratios out{std::vector<double>(positions.size(), 0.0),
             std::vector<double>(positions.size(), 0.0)};
  const auto note_at = [&](std::vector<double>& ratio, std::size_t k, double value) {
    double& at = ratio[std::min(k, positions.size() - 1)];
    at = std::max(at, value);
  };
  walk(course, positions, {},
       [&](std::size_t k, const std::vector<Watched>& axes, const std::vector<double>&) {
         double acceleration = 0.0, jerk = 0.0;
         for (const Watched& w : axes) {
           acceleration = std::max(acceleration, acceleration_excess(w));
           jerk = std::max(jerk, jerk_excess(w));
         }
         if (k >= 1) note_at(out.acceleration, k - 1, acceleration);
         if (k >= 1) note_at(out.jerk, k - 1, jerk);
         if (k >= 2) note_at(out.jerk, k - 2, jerk);
       });
  return out;
}

}  // namespace tubecut::motion
