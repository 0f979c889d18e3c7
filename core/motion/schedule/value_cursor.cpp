#include "core/motion/schedule/value_cursor.hpp"

#include <cmath>

namespace tubecut::motion {
namespace {

constexpr std::size_t kBevel = 2;          // index of the coordinate B
constexpr double kNearValue = 1.0 / 16.0;  // rad; beyond it the series would leave 1e-18

/// Rotates sine and cosine of an angle by at most `kNearValue`: Taylor's series of the rotation,
/// truncated below 3e-19, and the sum of the two angles.
elementary::SinCos turned(const elementary::SinCos& of, double by) {
  const double s = by * by;
  const double sine =
      by *
      (1.0 - s * (1.0 / 6.0) *
                 (1.0 - s * (1.0 / 20.0) * (1.0 - s * (1.0 / 42.0) * (1.0 - s * (1.0 / 72.0)))));
  const double less =  // 1 - cosine
      0.5 * s * (1.0 - s * (1.0 / 12.0) * (1.0 - s * (1.0 / 30.0) * (1.0 - s * (1.0 / 56.0))));
  return {of.sin + (of.cos * sine - of.sin * less), of.cos - (of.sin * sine + of.cos * less)};
}

}  // namespace

ValueCursor::ValueCursor(const Path& path, std::span<const AxisFunction> functions)
    : path_(path),
      functions_(functions.begin(), functions.end()),
      linear_(functions_.size()),
      values_(functions_.size()) {
  for (std::size_t f = 0; f < functions_.size(); ++f) {
    const AxisFunction& q = functions_[f];
    if (!q.is_linear()) bends_.push_back({f, q.sin_b, q.cos_b, q.tan_b});
  }
}

void ValueCursor::enter(std::size_t interval) {
  interval_ = interval;
  std::array<Cubic, kMostCoordinates> x{};
  const std::size_t n = path_.control.size();
  for (std::size_t c = 0; c < n; ++c) x[c] = path_.cubic(c, interval);
  for (std::size_t f = 0; f < functions_.size(); ++f) {
    Cubic sum{};
    for (std::size_t c = 0; c < n; ++c) {
      const double weight = functions_[f].linear[c];
      if (weight == 0.0) continue;
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * x[c][k];
    }
    sum[0] = functions_[f].constant + sum[0];
    linear_[f] = sum;
  }
  if (bends_.empty()) return;
  b_ = x[kBevel];
  at_start_ = elementary::sincos(b_[0]);
}

elementary::SinCos ValueCursor::lean(double w) const {
  const double by = w * (b_[1] + w * (b_[2] + w * b_[3]));
  return std::abs(by) <= kNearValue ? turned(at_start_, by) : elementary::sincos(b_[0] + by);
}

const std::vector<double>& ValueCursor::at(const Place& place) {
  const double w = place.offset;
  if (place.interval + 1 == path_.intervals() && w >= path_.d) {  // exactly the last control point
    const Coordinates x = path_.at(place.interval, w);
    for (std::size_t f = 0; f < functions_.size(); ++f) values_[f] = functions_[f].at(x);
    return values_;
  }
  if (place.interval != interval_) enter(place.interval);
  for (std::size_t f = 0; f < functions_.size(); ++f) {
    const Cubic& q = linear_[f];
    values_[f] = q[0] + w * (q[1] + w * (q[2] + w * q[3]));
  }
  if (bends_.empty()) return values_;
  const auto [sin, cos] = lean(w);
  for (const Bend& q : bends_) {
    values_[q.function] +=
        q.sin_b * sin + q.cos_b * cos + (q.tan_b == 0.0 ? 0.0 : q.tan_b * sin / cos);
  }
  return values_;
}

}  // namespace tubecut::motion
