#pragma once

#include <algorithm>
#include <cmath>

#include "core/joint/cutters/tube.hpp"

/// A tube relative to one generator: formulas shared by its own functions and the loops over many
/// stations.
namespace tubecut::joint {

/// The generator in the cutter's frame: u, v of the spec and the cutter's cross-section (X, S).
struct TubeLocal {
  double cos_delta, sin_delta, u, v, x;
  double below, above;  // r - X, r + X
  double s = 0.0;       // S, half the chord; 0 beyond the silhouette
};

// Computes r -+ X; on the side where the target's own side is nearest from sin^2 instead of 1 -
// cos, because next to a tangency r - rho cos(delta) would keep no digit.
[[nodiscard]] inline TubeLocal tube_local(const PreparedTube& t, double radius, double cos_phi,
                                          double sin_phi) {
  TubeLocal p{};
  p.cos_delta = cos_phi * t.cos_clocking + sin_phi * t.sin_clocking;
  p.sin_delta = sin_phi * t.cos_clocking - cos_phi * t.sin_clocking;
  p.u = radius * p.cos_delta;
  p.v = radius * p.sin_delta;
  p.x = p.u + t.offset;
  const double sagitta = p.v * p.sin_delta / (1.0 + std::abs(p.cos_delta));
  const bool front = p.cos_delta >= 0.0;
  p.below = front ? (t.radius - t.offset - radius) + sagitta : t.radius - p.x;
  p.above = front ? t.radius + p.x : (t.radius + t.offset - radius) + sagitta;
  p.s = std::sqrt(std::max(p.below, 0.0) * std::max(p.above, 0.0));
  return p;
}

[[nodiscard]] inline double tube_sheet(const PreparedTube& t, const TubeLocal& p) {
  return t.height + (p.s - p.v * t.cos_inclination) / t.sin_inclination;
}

/// Returns true if the generator meets the tube, except for rounding.
[[nodiscard]] inline bool tube_met(const PreparedTube& t, const TubeLocal& p, double radius) {
  return std::min(p.below, p.above) >= -kTouch * (t.radius + radius);
}

[[nodiscard]] inline double tube_slope(const PreparedTube& t, const TubeLocal& p) {
  return (p.x * p.v / p.s - p.u * t.cos_inclination) / t.sin_inclination;
}

/// The part of the wall of one phi in which the tube is met; empty when from > to.
struct TubeSection {
  double from, to;
};
[[nodiscard]] inline TubeSection tube_section(const PreparedTube& t, const Wall& wall,
                                              double cos_delta) {
  const double reach = t.radius + kTouch * (t.radius + wall.outer);
  const double c = std::abs(cos_delta);
  const double shift = cos_delta < 0.0 ? -t.offset : t.offset;  // |rho cos + s| = |rho c + shift|
  return {c * wall.inner + shift < -reach ? (-reach - shift) / c : wall.inner,
          c * wall.outer + shift > reach ? (reach - shift) / c : wall.outer};
}

}  // namespace tubecut::joint
