#include "core/motion/path/path_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr double kSampledMargin = 1.001;  // for bounds sampled at three points
constexpr double kNoise = 1e-9;           // relative size below which a derivative is rounding
constexpr double kNoLimit = 1e300;
constexpr double kUnderCap = 1.0 - 1e-9;  // rounding must not add a pulse above n_max

using Bound3 = std::array<double, 3>;

double magnitude(double a, double b, double c) {
  return std::max({std::abs(a), std::abs(b), std::abs(c)});
}

/// A linear axis: q' is quadratic, so its Bezier values bound it; q'' is linear, q''' constant.
Bound3 linear_bounds(const Bound3& a, const Bound3& b, double d) {
  const double middle = a[0] + 0.5 * d * a[1];  // = (P_(i+1) - P_i) / d
  return {magnitude(a[0], middle, b[0]), magnitude(a[1], b[1], 0.0), std::abs(a[2])};
}

Bound3 sampled_bounds(const Bound3& a, const Bound3& b, const Bound3& c, double d) {
  Bound3 out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = kSampledMargin * magnitude(a[k], b[k], c[k]);
  out[0] += d * d / 8.0 * out[2];
  return out;
}

void note_signed(AxisBounds& axis, std::size_t i, const Bound3& start, const Bound3& end) {
  axis.along.first[i] = start[0];
  axis.along.second[i] = start[1];
  axis.along.third[i] = start[2];
  axis.along.first[i + 1] = end[0];
  axis.along.second[i + 1] = end[1];
}

void drop_noise(AxisBounds& axis, double d) {
  double largest = 1.0;
  for (const double first : axis.first) largest = std::max(largest, first);
  double floor = kNoise * largest;
  const auto clean = [](std::vector<double>& values, double least) {
    for (double& value : values) {
      if (std::abs(value) < least) value = 0.0;
    }
  };
  const std::array bounds{&axis.first, &axis.second, &axis.third};
  const std::array signs{&axis.along.first, &axis.along.second, &axis.along.third};
  for (std::size_t k = 0; k < 3; ++k, floor /= d) {
    clean(*bounds[k], floor);
    clean(*signs[k], floor);
  }
}

bool moves(const AxisBounds& axis) {
  const auto any = [](const std::vector<double>& all) {
    return std::ranges::any_of(all, [](double value) { return value > 0.0; });
  };
  return any(axis.first) || any(axis.second) || any(axis.third);
}

struct TipRate {
  double largest = 0.0;
  Bound3 along{};  // at the start, the inner Bezier value, at the end
};

/// Computes the rate of the tip on an interval: its velocity is a quadratic (or nearly), so the
/// Bezier points bound it.
TipRate tip_rate(const std::vector<AxisFunction>& tip, const Jet& start, const Jet& middle,
                 const Jet& end, double d) {
  Bound3 square{};
  double third = 0.0;
  bool linear = true;
  for (const AxisFunction& f : tip) {
    const auto a = f.derivatives(start), b = f.derivatives(end);
    const auto m = f.derivatives(middle);
    const double inner = f.is_linear() ? a[0] + 0.5 * d * a[1] : m[0];
    linear = linear && f.is_linear();
    third = std::max({third, std::abs(a[2]), std::abs(m[2]), std::abs(b[2])});
    square[0] += a[0] * a[0];
    square[1] += inner * inner;
    square[2] += b[0] * b[0];
  }
  TipRate out{std::sqrt(std::max({square[0], square[1], square[2]})),
              {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2])}};
  if (linear) return out;
  out.largest = kSampledMargin * out.largest + d * d / 8.0 * third;
  for (double& value : out.along) value *= kSampledMargin;
  out.along[1] += d * d / 4.0 * third;  // the middle value is half as far out as the inner one
  return out;
}

constexpr double kHardlyMore = 1.02;

/// q' u_ddot + q'' x at one place of an interval is start x_i + end x_(i+1).
using Values = std::array<HalfPlane, 3>;

/// Returns the Bezier values: both ends, and start + d/2 times the derivative there, 3 q'' u_ddot +
/// q''' x.
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

/// Bezier values of a rate per mm of u on an interval, a quadratic, and its maximum magnitude.
struct Rate {
  double start = 0.0;
  double inner = 0.0;
  double end = 0.0;
  double largest = 0.0;
};

/// Returns the maximum of r^2 (1 - s) / r_0^2 + r^2 s / r_1^2 over an interval, by the Bezier
/// values of this polynomial of degree 5: the factor by which separate caps for each knot, x = v^2
/// / r^2, are exceeded between them. 1 or slightly more if the rate r hardly changes.
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

/// Returns caps at both knots of an interval for a speed `v`: from the rate at each if the values
/// between reduce them only slightly, else from the largest rate at both.
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

PathLimits path_limits(const Path& path, const std::vector<AxisFunction>& axes,
                       const std::vector<AxisFunction>& tip, const SpeedAlong& speed,
                       const Machine& machine) {
  const std::size_t n = path.intervals();
  const auto bent = [](const AxisFunction& f) { return !f.is_linear(); };
  const bool bends = std::ranges::any_of(axes, bent) || std::ranges::any_of(tip, bent);
  PathLimits out;
  out.d = path.d;
  out.slowness.resize(n);
  std::vector<AxisBounds> all(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Axis& axis = machine.axes[a];
    all[a] = {a,
              {},
              {},
              {},
              kUnderCap * velocity_limit(axis, machine.period),
              axis.a_max,
              axis.j_max.value_or(0.0),
              {{}, {}, {}, axes[a].is_linear()}};
    auto& [first, second, third, linear] = all[a].along;
    for (auto* const values : {&all[a].first, &all[a].second, &all[a].third, &third}) {
      if (stopped()) return out;  // because this touches the memory for the first time
      values->resize(n);
    }
    for (auto* const values : {&first, &second}) values->resize(n + 1);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (stopped()) return out;
    const Jet start = path.jet(i, 0.0, bends), middle = path.jet(i, 0.5 * path.d, bends);
    const Jet end = path.jet(i, path.d, bends);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const Bound3 first = axes[a].derivatives(start), last = axes[a].derivatives(end);
      const Bound3 bound = axes[a].is_linear()
                               ? linear_bounds(first, last, path.d)
                               : sampled_bounds(first, axes[a].derivatives(middle), last, path.d);
      all[a].first[i] = bound[0];
      all[a].second[i] = bound[1];
      all[a].third[i] = bound[2];
      note_signed(all[a], i, first, last);
    }
    const double u = path.d * static_cast<double>(i);
    const TipRate rate = tip_rate(tip, start, middle, end, path.d);
    const double least = speed.least(u, u + path.d);
    out.slowness[i] = rate.largest / least;
    out.slowness_along.push_back(
        {rate.along[0] / least, rate.along[1] / least, rate.along[2] / least});
  }
  for (AxisBounds& axis : all) {
    drop_noise(axis, path.d);
    if (moves(axis)) out.axes.push_back(std::move(axis));
  }
  return out;
}

Conditions without_jerk(const PathLimits& limits) {
  const std::size_t n = limits.intervals();
  Conditions out;
  out.caps.assign(n + 1, kNoLimit);
  out.rows.rows.reserve(n * limits.axes.size());  // because growth would move all of them at once
  for (std::size_t i = 0; i < n; ++i) {
    if (stops(i)) return out;
    double fastest = limits.slowness[i] > 0.0 ? 1.0 / limits.slowness[i] : 1e150;
    for (const AxisBounds& axis : limits.axes) {
      if (axis.first[i] > 0.0) fastest = std::min(fastest, axis.v_max / axis.first[i]);
      out.rows.add({axis.first[i], axis.second[i], axis.a_max});
    }
    out.rows.close_interval();
    for (const std::size_t knot : {i, i + 1}) {
      out.caps[knot] = std::min(out.caps[knot], fastest * fastest);
    }
  }
  out.caps.front() = out.caps.back() = 0.0;
  return out;
}

std::vector<double> speed_caps(const PathLimits& limits) {
  std::vector<double> caps(limits.intervals() + 1, kNoLimit);
  for (std::size_t i = 0; i < limits.intervals() && !stops(i); ++i) {
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

HalfPlanes acceleration_rows(const PathLimits& limits) {
  HalfPlanes out;
  out.rows.reserve(6 * limits.intervals() * limits.axes.size());
  for (std::size_t i = 0; i < limits.intervals() && !stops(i); ++i) {
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
