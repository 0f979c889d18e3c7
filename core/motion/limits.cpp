#include "core/motion/limits.hpp"

#include <algorithm>
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
Bound3 linear_bounds(const AxisFunction& f, const Jet& start, const Jet& end, double d) {
  const auto a = f.derivatives(start), b = f.derivatives(end);
  const double middle = a[0] + 0.5 * d * a[1];  // = (P_(i+1) - P_i) / d
  return {magnitude(a[0], middle, b[0]), magnitude(a[1], b[1], 0.0), std::abs(a[2])};
}

Bound3 sampled_bounds(const AxisFunction& f, const Jet& start, const Jet& middle, const Jet& end,
                      double d) {
  const auto a = f.derivatives(start), b = f.derivatives(middle), c = f.derivatives(end);
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

/// Rate of the tip on an interval: its velocity is a quadratic (or nearly), so the Bezier points
/// bound it.
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
  out.along[1] += d * d / 4.0 * third;  // the middle value lies half as far out as the inner one
  return out;
}

}  // namespace

Limits limits(const Path& path, const std::vector<AxisFunction>& axes,
              const std::vector<AxisFunction>& tip, const SpeedAlong& speed, const Machine& machine,
              const std::stop_token& stop) {
  const std::size_t n = path.intervals();
  Limits out;
  out.d = path.d;
  out.slowness.resize(n);
  std::vector<AxisBounds> all(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Axis& axis = machine.axes[a];
    const std::vector<double> intervals(n), knots(n + 1);
    all[a] = {a,
              intervals,
              intervals,
              intervals,
              kUnderCap * velocity_limit(axis, machine.period),
              axis.a_max,
              axis.j_max.value_or(0.0),
              {knots, knots, intervals, axes[a].is_linear()}};
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (stop.stop_requested()) return out;
    const Jet start = path.jet(i, 0.0), middle = path.jet(i, 0.5 * path.d);
    const Jet end = path.jet(i, path.d);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const Bound3 bound = axes[a].is_linear()
                               ? linear_bounds(axes[a], start, end, path.d)
                               : sampled_bounds(axes[a], start, middle, end, path.d);
      all[a].first[i] = bound[0];
      all[a].second[i] = bound[1];
      all[a].third[i] = bound[2];
      note_signed(all[a], i, axes[a].derivatives(start), axes[a].derivatives(end));
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

std::vector<double> largest_profile(std::vector<double> x, double d, const Rows& rows,
                                    const std::stop_token& stop) {
  const std::size_t n = x.size() - 1;
  std::vector<double> slope(rows.rows.size()), shift(rows.rows.size());
  for (std::size_t i = 0; i < n && !stops(stop, i); ++i) {
    for (std::size_t r = rows.first[i]; r < rows.first[i + 1]; ++r) {
      const Row& row = rows.rows[r];
      const double below = row.alpha + 2.0 * d * row.beta;
      slope[r] = below > 0.0 ? row.alpha / below : 1.0;
      shift[r] = below > 0.0 ? 2.0 * d * row.c / below : kNoLimit;
      if (row.beta <= 0.0) continue;
      x[i] = std::min(x[i], row.c / row.beta);
      x[i + 1] = std::min(x[i + 1], row.c / row.beta);
    }
  }
  const auto reach = [&](std::size_t i, double from) {
    double most = kNoLimit;
    for (std::size_t r = rows.first[i]; r < rows.first[i + 1]; ++r) {
      most = std::min(most, slope[r] * from + shift[r]);
    }
    return most;
  };
  for (std::size_t i = 0; i < n && !stops(stop, i); ++i)
    x[i + 1] = std::min(x[i + 1], reach(i, x[i]));
  for (std::size_t i = n; i-- > 0 && !stops(stop, i);) x[i] = std::min(x[i], reach(i, x[i + 1]));
  return x;
}

Conditions without_jerk(const Limits& limits, const std::stop_token& stop) {
  const std::size_t n = limits.intervals();
  Conditions out;
  out.caps.assign(n + 1, kNoLimit);
  for (std::size_t i = 0; i < n; ++i) {
    if (stops(stop, i)) return out;
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

double duration(const std::vector<double>& x, double d) {
  double time = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    time += 2.0 * d / (std::sqrt(x[i]) + std::sqrt(x[i + 1]));
  }
  return time;
}

}  // namespace tubecut::motion
