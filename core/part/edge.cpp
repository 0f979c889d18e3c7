#include "core/part/edge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/angle.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::part {
namespace {

constexpr double kAlike = 0.01;  // mm

}  // namespace

Edge::Span Edge::at(double angle) const {
  const double at = math::whole_turn(angle);
  const auto n = phi.size();
  const auto from = static_cast<std::size_t>(std::ranges::lower_bound(phi, at) - phi.begin());
  Span out{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t i = from; i < n && phi[i] == at; ++i) {
    out.low = std::min(out.low, z[i]);
    out.high = std::max(out.high, z[i]);
  }
  if (out.low <= out.high) return out;
  const auto before = (from + n - 1) % n;
  const auto after = from % n;
  double start = phi[before], end = phi[after], here = at;
  if (from == 0) start -= kTwoPi;
  if (from == n) end += kTwoPi;
  const double t = end > start ? (here - start) / (end - start) : 0.0;
  out.low = out.high = (1.0 - t) * z[before] + t * z[after];
  return out;
}

double Edge::lowest() const { return *std::ranges::min_element(z); }
double Edge::highest() const { return *std::ranges::max_element(z); }

std::size_t Edge::extreme(bool upwards) const {
  const double sign = upwards ? 1.0 : -1.0;
  const double best = sign * (upwards ? highest() : lowest());
  const auto n = z.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double here = sign * z[i];
    const bool stands_out = here >= sign * z[(i + 1) % n] && here >= sign * z[(i + n - 1) % n];
    if (stands_out && here >= best - kAlike) return i;
  }
  return 0;
}

double Edge::turn_integral() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const auto j = (i + 1) % phi.size();
    const double step = phi[j] - phi[i] + (j == 0 ? kTwoPi : 0.0);
    sum += 0.5 * step * (z[i] + z[j]);
  }
  return sum;
}

double ring_volume(std::span<const double> radii, std::span<const Edge> edges) {
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < radii.size(); ++k) {
    const double inner = radii[k], t = radii[k + 1] - radii[k];
    sum += t * ((inner / 2.0 + t / 6.0) * edges[k].turn_integral() +
                (inner / 2.0 + t / 3.0) * edges[k + 1].turn_integral());
  }
  return sum;
}

}  // namespace tubecut::part
