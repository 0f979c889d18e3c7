#include "core/motion/schedule/value_cursor.hpp"

#include <cmath>

namespace tubecut::motion {
namespace {

constexpr std::size_t kBevel = 2;                     // index of the coordinate B
constexpr std::size_t kUp = 0, kTipX = 3, kTipY = 4;  // of the normal's angle and of the tip across
constexpr double kNearValue = 1.0 / 16.0;             // rad; beyond it the series would leave 1e-18

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

/// Returns sine and cosine of an angle, a cubic, this far after its start.
elementary::SinCos moved(const std::array<double, 4>& angle, const elementary::SinCos& at_start,
                         double w) {
  const double by = w * (angle[1] + w * (angle[2] + w * angle[3]));
  return std::abs(by) <= kNearValue ? turned(at_start, by) : elementary::sincos(angle[0] + by);
}

}  // namespace

ValueCursor::ValueCursor(const Path& path, std::span<const AxisFunction> functions)
    : path_(path),
      functions_(functions.begin(), functions.end()),
      linear_(functions_.size()),
      values_(functions_.size()) {
  for (std::size_t f = 0; f < functions_.size(); ++f) {
    const AxisFunction& q = functions_[f];
    if (q.sin_b != 0.0 || q.cos_b != 0.0 || q.tan_b != 0.0)
      bends_.push_back({f, q.sin_b, q.cos_b, q.tan_b});
    if (q.turns()) turns_.push_back({f, q.across, q.out});
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
  if (!turns_.empty()) {
    up_ = x[kUp];
    x_ = x[kTipX];
    y_ = x[kTipY];
    up_at_start_ = elementary::sincos(up_[0]);
  }
  if (bends_.empty()) return;
  b_ = x[kBevel];
  at_start_ = elementary::sincos(b_[0]);
}

void ValueCursor::add_turns(double w) {
  const auto at = [w](const Cubic& q) { return q[0] + w * (q[1] + w * (q[2] + w * q[3])); };
  const auto [sin, cos] = moved(up_, up_at_start_, w);
  const double x = at(x_), y = at(y_);
  for (const Turn& q : turns_)
    values_[q.function] += q.across * (y * cos - x * sin) + q.out * (x * cos + y * sin);
}

const std::vector<double>& ValueCursor::at(const PathPosition& position) {
  const double w = position.offset;
  if (position.interval + 1 == path_.intervals() &&
      w >= path_.d) {  // exactly the last control point
    const Coordinates x = path_.at(position.interval, w);
    for (std::size_t f = 0; f < functions_.size(); ++f) values_[f] = functions_[f].at(x);
    return values_;
  }
  if (position.interval != interval_) enter(position.interval);
  for (std::size_t f = 0; f < functions_.size(); ++f) {
    const Cubic& q = linear_[f];
    values_[f] = q[0] + w * (q[1] + w * (q[2] + w * q[3]));
  }
  if (!turns_.empty()) add_turns(w);
  if (bends_.empty()) return values_;
  const auto [sin, cos] = moved(b_, at_start_, w);
  for (const Bend& q : bends_) {
    values_[q.function] +=
        q.sin_b * sin + q.cos_b * cos + (q.tan_b == 0.0 ? 0.0 : q.tan_b * sin / cos);
  }
  return values_;
}

}  // namespace tubecut::motion
