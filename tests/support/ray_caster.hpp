#pragma once

// An independent oracle of the contour: long double, distances to axes in space, bracketing and
// bisection. It includes no code of core and uses no formula of it.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace tubecut::ray {

using Real = long double;
using Point = std::array<Real, 3>;

inline constexpr Real kPi = 3.141592653589793238462643383279502884L;

/// An infinite cylinder by its axis (a point and a unit direction), or a half space below a plane
/// (radius 0: the point is on the plane, the direction is its normal, upwards).
struct Body {
  Real radius = 0;
  Point point{};
  Point direction{};
};

inline Point turned(const Point& p, int from, int to, Real angle) {
  Point out = p;
  const auto i = static_cast<std::size_t>(from);
  const auto j = static_cast<std::size_t>(to);
  out[i] = std::cos(angle) * p[i] - std::sin(angle) * p[j];
  out[j] = std::sin(angle) * p[i] + std::cos(angle) * p[j];
  return out;
}

/// A tube that lies on the z axis is shifted by -offset along x, tilted by `inclination` about x,
/// turned by `clocking` about z, lifted by `height`. Angles in rad.
inline Body tube(Real radius, Real inclination, Real clocking, Real offset, Real height) {
  const auto place = [&](Point p) {
    p[0] -= offset;
    p = turned(turned(p, 1, 2, inclination), 0, 1, clocking);
    p[2] += height;
    return p;
  };
  const Point a = place({0, 0, 0});
  const Point b = place({0, 0, 1});
  return {radius, a, {b[0] - a[0], b[1] - a[1], b[2] - a[2]}};
}

/// How far outside the body a point is (negative: inside), for a tube squared.
inline Real outside(const Body& body, const Point& p) {
  const Real x = p[0] - body.point[0];
  const Real y = p[1] - body.point[1];
  const Real z = p[2] - body.point[2];
  const auto& d = body.direction;
  if (body.radius == 0) return x * d[0] + y * d[1] + z * d[2];
  const Real cx = y * d[2] - z * d[1];
  const Real cy = z * d[0] - x * d[2];
  const Real cz = x * d[1] - y * d[0];
  return cx * cx + cy * cy + cz * cz - body.radius * body.radius;
}

/// Highest z on the generator at phi that is inside the body; empty if the generator misses it.
inline std::optional<Real> top(const Body& body, Real rho, Real phi) {
  Point p{rho * std::cos(phi), rho * std::sin(phi), 0};
  const auto f = [&](Real z) {
    p[2] = z;
    return outside(body, p);
  };
  Real low = -1e6L;
  if (body.radius > 0) {  // the lowest value of a parabola through three of its points
    const Real span = 64 * body.radius;
    const Real a = f(-span);
    const Real m = f(0);
    const Real b = f(span);
    low = span * (a - b) / (2 * (a - 2 * m + b));
  }
  if (f(low) > 0) return std::nullopt;
  Real step = 1;
  while (f(low + step) <= 0) step *= 2;
  Real high = low + step;
  for (int i = 0; i < 90; ++i) {
    const Real mid = (low + high) / 2;
    (f(mid) <= 0 ? low : high) = mid;
  }
  return low;
}

struct Top {
  Real z = 0;
  std::size_t body = 0;
  Real lead = 0;  // over the second highest
};

/// The highest body on a generator, and by how much.
inline std::optional<Top> highest(const std::vector<Body>& bodies, Real rho, Real phi) {
  std::optional<Top> best;
  Real second = -std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto z = top(bodies[i], rho, phi);
    if (!z) continue;
    if (!best || *z > best->z) {
      if (best) second = best->z;
      best = Top{*z, i, 0};
    } else if (*z > second) {
      second = *z;
    }
  }
  if (best) best->lead = best->z - second;
  return best;
}

}  // namespace tubecut::ray
