#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/motion/lead.hpp"

namespace tubecut::motion {
namespace {

/// A point of one wall surface, developed.
struct Flat {
  double s = 0.0;
  double z = 0.0;
};

/// Where the beam through a point of the contour's surface meets the surface of radius `rho`.
Flat on_surface(const PartBorder& part, const ContourPoint& p, double rho) {
  return {rho * p.phi, p.z - part.sigma * (rho - part.cut.radius) * elementary::tan(p.b)};
}

double distance(Flat p, Flat a, Flat b) {
  const double s = b.s - a.s, z = b.z - a.z;
  const double square = s * s + z * z;
  const double along = square > 0.0 ? ((p.s - a.s) * s + (p.z - a.z) * z) / square : 0.0;
  const double k = std::clamp(along, 0.0, 1.0);
  return elementary::hypot(p.s - a.s - k * s, p.z - a.z - k * z);
}

bool crosses_above(Flat p, Flat a, Flat b) {
  if ((a.s <= p.s) == (b.s <= p.s)) return false;
  return a.z + (b.z - a.z) * (p.s - a.s) / (b.s - a.s) > p.z;
}

/// Signed distance to the border on one surface: positive inside the kept part.
double depth(const PartBorder& part, const ContourPoint& point, double rho) {
  const Flat p = on_surface(part, point, rho);
  double nearest = 1e300;
  bool odd = false;
  Flat a = on_surface(part, part.cut.points.front(), rho);
  for (std::size_t i = 1; i < part.cut.points.size(); ++i) {
    const Flat b = on_surface(part, part.cut.points[i], rho);
    nearest = std::min(nearest, distance(p, a, b));
    odd = odd != crosses_above(p, a, b);
    a = b;
  }
  const bool kept = part.scrap == Scrap::plus_z ? odd : !odd;
  return kept ? nearest : -nearest;
}

/// The point turned by whole turns into the span of the border.
ContourPoint wrapped(const Track& cut, ContourPoint p) {
  const auto [low, high] = std::ranges::minmax(cut.points, {}, &ContourPoint::phi);
  const double from = cut.turns == 0 ? 0.5 * (low.phi + high.phi) - kPi : low.phi;
  p.phi -= kTwoPi * std::floor((p.phi - from) / kTwoPi);
  return p;
}

/// One turn of a ring seen from a point near its seam needs the neighbouring turn for the distance.
double depth_on_ring(const PartBorder& part, const ContourPoint& p, double rho) {
  const double here = depth(part, p, rho);
  if (part.cut.turns == 0) return here;
  double nearest = std::abs(here);
  for (const double turn : {-kTwoPi, kTwoPi}) {
    ContourPoint moved = p;
    moved.phi += turn;
    nearest = std::min(nearest, std::abs(depth(part, moved, rho)));
  }
  return here < 0.0 ? -nearest : nearest;
}

}  // namespace

double intrusion(const PartBorder& part, const ContourPoint& point) {
  const ContourPoint p = wrapped(part.cut, point);
  const double middle = 0.5 * (part.inner_radius + part.outer_radius);
  double deepest = -1e300;
  for (const double rho : {part.inner_radius, middle, part.outer_radius}) {
    deepest = std::max(deepest, depth_on_ring(part, p, rho));
  }
  return deepest;
}

}  // namespace tubecut::motion
