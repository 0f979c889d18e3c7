#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/motion/limits.hpp"

namespace tubecut::motion {
namespace {

constexpr double kNoLimit = 1e300;
constexpr double kHardlyMore = 1.02;
constexpr double kSampledMargin = 1.001;  // as for the bounds of axes that are not linear

/// q' u_ddot + q'' x at one place of an interval is start x_i + end x_(i+1).
using Values = std::array<HalfPlane, 3>;

/// The Bezier values: both ends, and start + d/2 times the derivative there, 3 q'' u_ddot + q''' x.
Values bezier_values(const AxisBounds& axis, std::size_t i, double d) {
  const double per_step = 0.5 / d;  // u_ddot = (x_(i+1) - x_i) per_step
  const auto at = [&](double first, double second, bool end) {
    const double pull = first * per_step;
    return HalfPlane{-pull + (end ? 0.0 : second), pull + (end ? second : 0.0)};
  };
  const HalfPlane start = at(axis.along.first[i], axis.along.second[i], false);
  const HalfPlane end = at(axis.along.first[i + 1], axis.along.second[i + 1], true);
  const double turn = 0.75 * axis.along.second[i];
  const HalfPlane middle{start.start - turn + 0.5 * d * axis.along.third[i], start.end + turn};
  return {start, middle, end};
}

/// Bezier values of a rate per mm of u on an interval, a quadratic, and its largest size.
struct Rate {
  double start = 0.0;
  double inner = 0.0;
  double end = 0.0;
  double largest = 0.0;
};

/// Largest value of r^2 (1 - s) / r_0^2 + r^2 s / r_1^2 over an interval, by the Bezier values of
/// this polynomial of degree 5: what a cap for each knot by itself, x = v^2 / r^2, allows too much
/// between them. 1 or a little more where the rate r hardly changes.
double between_caps(const Rate& r) {
  const double a = r.start, b = r.inner, c = r.end;
  const std::array square{a * a, a * b, (2.0 * b * b + a * c) / 3.0, b * c, c * c};
  double most = 1.0;
  for (std::size_t k = 1; k < square.size(); ++k) {
    const auto share = static_cast<double>(k) / 5.0;
    most = std::max(most, (1.0 - share) * square[k] / (a * a) + share * square[k - 1] / (c * c));
  }
  return most;
}

/// Caps at both knots of an interval for a speed `v`: by the rate at each, where what lies between
/// them takes little of that away, else by the largest rate at both.
std::array<double, 2> interval_caps(const Rate& r, double v) {
  if (r.largest == 0.0) return {kNoLimit, kNoLimit};
  if (std::min(std::abs(r.start), std::abs(r.end)) > 0.5 * r.largest) {
    const double between = between_caps(r);
    const double most = v * v / between;
    if (between < kHardlyMore) return {most / (r.start * r.start), most / (r.end * r.end)};
  }
  const double both = v * v / (r.largest * r.largest);
  return {both, both};
}

Rate rate_of(const AxisBounds& axis, std::size_t i, double d) {
  const SignedDerivatives& q = axis.along;
  const double margin = q.linear ? 1.0 : kSampledMargin;
  const double inner = q.first[i] + 0.5 * d * q.second[i];
  return {margin * q.first[i], margin * inner, margin * q.first[i + 1], axis.first[i]};
}

}  // namespace

std::vector<double> speed_caps(const Limits& limits, const std::stop_token& stop) {
  std::vector<double> caps(limits.intervals() + 1, kNoLimit);
  for (std::size_t i = 0; i < limits.intervals() && !stops(stop, i); ++i) {
    const auto cap = [&](const Rate& rate, double v) {
      const auto [start, end] = interval_caps(rate, v);
      caps[i] = std::min(caps[i], start);
      caps[i + 1] = std::min(caps[i + 1], end);
    };
    const auto& [start, inner, end] = limits.slowness_along[i];
    cap({start, inner, end, limits.slowness[i]}, 1.0);
    for (const AxisBounds& axis : limits.axes) cap(rate_of(axis, i, limits.d), axis.v_max);
  }
  caps.front() = caps.back() = 0.0;
  return caps;
}

HalfPlanes acceleration_rows(const Limits& limits, const std::stop_token& stop) {
  HalfPlanes out;
  out.rows.reserve(6 * limits.intervals() * limits.axes.size());
  for (std::size_t i = 0; i < limits.intervals() && !stops(stop, i); ++i) {
    for (const AxisBounds& axis : limits.axes) {
      if (axis.first[i] == 0.0 && axis.second[i] == 0.0) continue;
      const double most = axis.along.linear ? axis.a_max : axis.a_max / kSampledMargin;
      for (const HalfPlane& value : bezier_values(axis, i, limits.d)) {
        out.add(value.start / most, value.end / most);
        out.add(-value.start / most, -value.end / most);
      }
    }
    out.close_interval();
  }
  return out;
}

}  // namespace tubecut::motion
