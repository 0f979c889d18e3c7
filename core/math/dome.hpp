#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace tubecut::math {

/// The concave function c x + k sqrt(h^2 - (a + b x)^2), for |a + b x| <= h; k, h > 0: a round
/// beam's height over the points of a straight line.
struct Dome {
  double c, k, a, b, h;

  [[nodiscard]] double at(double x) const {
    const double u = a + b * x;
    return c * x + k * std::sqrt(std::max(0.0, (h - u) * (h + u)));
  }
};

/// Returns the x of [low, high] at which a dome is highest; nothing if it is not defined there.
[[nodiscard]] inline std::optional<double> highest(const Dome& dome, double low, double high) {
  constexpr double kParallel = 1e-13;  // the line runs along the beam
  const auto& [c, k, a, b, h] = dome;
  if (std::abs(b) < kParallel) {
    if (!(std::abs(a) < h && low <= high)) return std::nullopt;
    return c > 0.0 ? high : low;
  }
  const double one = (-h - a) / b, other = (h - a) / b;
  const double from = std::max(low, std::min(one, other)),
               to = std::min(high, std::max(one, other));
  if (!(from <= to)) return std::nullopt;
  const double slope = c / (k * b);
  const double top = (h * slope / std::sqrt(1.0 + slope * slope) - a) / b;
  return std::clamp(top, from, to);
}

}  // namespace tubecut::math
