#include "core/motion/pulses.hpp"

#include <cmath>

namespace tubecut::motion {

double ideal_pulses(const Axis& axis, double q, double start) {
  if (axis.pulses_per_turn > 0) {
    return (q - start) / 360.0 * static_cast<double>(axis.pulses_per_turn);
  }
  return (q - start) * axis.pulses_per_unit;
}

std::int64_t rounded(double pulses) { return static_cast<std::int64_t>(std::floor(pulses + 0.5)); }

std::vector<std::int32_t> increments(std::span<const double> cumulative) {
  std::vector<std::int32_t> out;
  if (cumulative.empty()) return out;
  out.reserve(cumulative.size() - 1);
  std::int64_t before = rounded(cumulative.front());
  for (const double p : cumulative.subspan(1)) {
    const std::int64_t now = rounded(p);
    out.push_back(static_cast<std::int32_t>(now - before));
    before = now;
  }
  return out;
}

}  // namespace tubecut::motion
