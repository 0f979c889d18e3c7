#include "core/bevel/kerf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kSteep =
    3.0;  // tan gamma from which the plane's formula is held against the disc's

/// Lowest z of the curve within `reach` (rad) of node i, both ends of the stretch included.
double lowest_near(const joint::Contour& contour, const std::vector<joint::Node>& nodes,
                   std::size_t i, double reach) {
  const auto n = nodes.size();
  const auto at = [&](double phi) {
    const double turn = std::floor(phi / kTwoPi);
    return joint::contact_at(contour, phi - turn * kTwoPi).z;
  };
  double lowest = std::min(at(nodes[i].phi - reach), at(nodes[i].phi + reach));
  for (std::size_t k = 0; k < n; ++k) {  // forwards
    const auto j = (i + k) % n;
    const double ahead = nodes[j].phi - nodes[i].phi + (j < i ? kTwoPi : 0.0);
    if (ahead > reach) break;
    lowest = std::min(lowest, nodes[j].z);
  }
  for (std::size_t k = 1; k < n; ++k) {  // backwards
    const auto j = (i + n - k) % n;
    const double behind = nodes[i].phi - nodes[j].phi + (j > i ? kTwoPi : 0.0);
    if (behind > reach) break;
    lowest = std::min(lowest, nodes[j].z);
  }
  return lowest;
}

}  // namespace

std::vector<double> kerf_drops(const joint::Contour& contour, const joint::Samples& samples,
                               std::span<const double> b, std::span<const double> gamma,
                               double kerf) {
  const double half = kerf / 2.0;
  std::vector<double> out(b.size(), 0.0);
  if (kerf == 0.0) return out;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double tan_b = elementary::tan(b[i]);
    const double cos_gamma =
        std::max(elementary::cos(gamma[i]), std::numeric_limits<double>::min());
    const double tan_gamma = elementary::sin(gamma[i]) / cos_gamma;
    const double plane = half * elementary::hypot(1.0, tan_b, tan_gamma);
    out[i] = plane;
    if (std::abs(tan_gamma) < kSteep) continue;
    const double disc = samples.nodes[i].z -
                        lowest_near(contour, samples.nodes, i, half / contour.radius) +
                        half * elementary::hypot(1.0, tan_b);
    out[i] = std::min(plane, disc);
  }
  return out;
}

}  // namespace tubecut::bevel
