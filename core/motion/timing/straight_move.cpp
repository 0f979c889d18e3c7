#include "core/motion/timing/straight_move.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

constexpr double kFree = 1e300;
constexpr double kInsideShare = 1.0 - 1e-9;  // rounding must not raise a count above n_max

}  // namespace

SCurve SCurve::fastest(double v, double a, std::optional<double> j) {
  if (!j) {
    if (v * v > a) v = std::sqrt(a);  // the path is 1: too short to reach it
    return {1.0 / v, v / a, 0.0};
  }
  if (v * *j < a * a) a = std::sqrt(v * *j);
  if (1.0 / v >= v / a + a / *j) return {1.0 / v, v / a, a / *j};
  // Half the path to accelerate, half to decelerate: v (v / a + a / j) = 1, whether a is reached or
  // not.
  const double t = a / *j;
  v = 0.5 * a * (std::sqrt(t * t + 4.0 / a) - t);
  if (v / a >= t) return {v / a + t, v / a, t};
  const double ramp = elementary::cbrt(0.5 / *j);
  return {2.0 * ramp, ramp, ramp};
}

double SCurve::first_half(double t) const {
  const double mean = 0.5 * (rise_ + jerk_);
  if (t < jerk_) return t * t * t / (6.0 * cruise_ * rise_ * jerk_);
  if (t < rise_) return (0.5 * t * (t - jerk_) + jerk_ * jerk_ / 6.0) / (cruise_ * rise_);
  const double left = rise_ + jerk_ - t;
  const double bend =
      left > 0.0 && jerk_ > 0.0 ? left * left * left / (6.0 * cruise_ * rise_ * jerk_) : 0.0;
  return (t - mean) / cruise_ + bend;
}

double SCurve::at(double t) const {
  t = std::clamp(t, 0.0, time());
  return t <= 0.5 * time() ? first_half(t) : 1.0 - first_half(time() - t);
}

std::optional<SCurve> timed(const StraightMove& move, const Machine& machine, bool jerk) {
  double v = kFree, a = kFree;
  std::optional<double> j;
  bool moves = false;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const double way = std::abs(move.to[i] - move.from[i]);
    if (way == 0.0) continue;
    const Axis& axis = machine.axes[i];
    moves = true;
    v = std::min(v, kInsideShare * velocity_limit(axis, machine.period) / way);
    a = std::min(a, kInsideShare * axis.a_max / way);
    if (jerk && axis.j_max) j = std::min(j.value_or(kFree), kInsideShare * *axis.j_max / way);
  }
  if (!moves) return std::nullopt;
  if (move.speed > 0.0 && move.length > 0.0) v = std::min(v, move.speed / move.length);
  return SCurve::fastest(v, a, j);
}

}  // namespace tubecut::motion
