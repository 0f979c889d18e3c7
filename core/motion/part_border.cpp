#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
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
double depth(const PartBorder& part, const ContourPoint& point, double rho,
             const std::stop_token& stop) {
  const Flat p = on_surface(part, point, rho);
  double nearest = 1e300;
  bool odd = false;
  Flat a = on_surface(part, part.cut.points.front(), rho);
  for (std::size_t i = 1; i < part.cut.points.size() && !stops(stop, i); ++i) {
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
double depth_on_ring(const PartBorder& part, const ContourPoint& p, double rho,
                     const std::stop_token& stop) {
  const double here = depth(part, p, rho, stop);
  if (part.cut.turns == 0) return here;
  double nearest = std::abs(here);
  for (const double turn : {-kTwoPi, kTwoPi}) {
    ContourPoint moved = p;
    moved.phi += turn;
    nearest = std::min(nearest, std::abs(depth(part, moved, rho, stop)));
  }
  return here < 0.0 ? -nearest : nearest;
}

/// A point of a track as (s, z, b), and differences of such points.
using Spot = std::array<double, 3>;

Spot mixed(double p, const Spot& a, double q, const Spot& b) {
  return {p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2]};
}

double tip_length(const Spot& a) { return elementary::hypot(a[0], a[1]); }

/// Chords of a closed track, segment by segment, and the tangents per mm of the tip at their ends.
class Curve {
 public:
  explicit Curve(const Track& track) : track_(track) {
    for (const ContourPoint& p : track.points) {
      spots_.push_back({track.radius * p.phi, p.z, p.b});
    }
  }

  /// Segment `i` at share `w`.
  [[nodiscard]] ContourPoint at(std::size_t i, double w) const {
    const double l = length(i);
    const Spot start = tangent(i, i), end = tangent(i + 1, i);
    const double v = 1.0 - w;
    const Spot ends =
        mixed(v * v * (1.0 + 2.0 * w), spots_[i], w * w * (3.0 - 2.0 * w), spots_[i + 1]);
    const Spot bends = mixed(l * w * v * v, start, -l * w * w * v, end);
    const Spot x = mixed(1.0, ends, 1.0, bends);
    return {x[0] / track_.radius, x[1], x[2], false, 0.0};
  }

  /// Distance of segment `i`'s chord to the curve in its middle.
  [[nodiscard]] double sag(std::size_t i) const {
    if (length(i) == 0.0) return 0.0;
    return 0.125 * length(i) * tip_length(mixed(1.0, tangent(i, i), -1.0, tangent(i + 1, i)));
  }

 private:
  static constexpr double kCorner = 0.94;  // cosine of 20 deg

  [[nodiscard]] std::size_t segments() const { return spots_.size() - 1; }
  [[nodiscard]] Spot chord(std::size_t i) const {
    return mixed(1.0, spots_[i + 1], -1.0, spots_[i]);
  }
  [[nodiscard]] double length(std::size_t i) const { return tip_length(chord(i)); }
  [[nodiscard]] Spot slope(std::size_t i) const {
    return mixed(1.0 / length(i), chord(i), 0.0, {});
  }

  /// Tangent at knot `k` for the segment `own` beside it.
  [[nodiscard]] Spot tangent(std::size_t k, std::size_t own) const {
    const std::size_t before = k == 0 ? segments() - 1 : k - 1;
    const std::size_t after = k == segments() ? 0 : k;
    const double a = length(before), b = length(after);
    if (a == 0.0 || b == 0.0 || track_.points[k].corner) return slope(own);
    const Spot m = slope(before), n = slope(after);
    if (m[0] * n[0] + m[1] * n[1] < kCorner) return slope(own);
    return mixed(b / (a + b), m, a / (a + b), n);
  }

  const Track& track_;
  std::vector<Spot> spots_;
};

}  // namespace

SmoothTrack smooth_border(const Track& track) {
  constexpr double kSag = 0.002;  // mm
  constexpr double kMostPieces = 32.0;
  SmoothTrack out{track, 0.0};
  if (!track.closed) return out;
  const Curve curve(track);
  out.track.points.clear();
  for (std::size_t i = 0; i + 1 < track.points.size(); ++i) {
    const double sag = curve.sag(i);
    out.sag = std::max(out.sag, sag);
    out.track.points.push_back(track.points[i]);
    const auto pieces = static_cast<int>(std::min(kMostPieces, std::ceil(std::sqrt(sag / kSag))));
    for (int k = 1; k < pieces; ++k) {
      out.track.points.push_back(curve.at(i, static_cast<double>(k) / pieces));
    }
  }
  out.track.points.push_back(track.points.back());
  return out;
}

double intrusion(const PartBorder& part, const ContourPoint& point, const std::stop_token& stop) {
  const ContourPoint p = wrapped(part.cut, point);
  const double middle = 0.5 * (part.inner_radius + part.outer_radius);
  double deepest = -1e300;
  for (const double rho : {part.inner_radius, middle, part.outer_radius}) {
    deepest = std::max(deepest, depth_on_ring(part, p, rho, stop));
  }
  return deepest;
}

}  // namespace tubecut::motion
