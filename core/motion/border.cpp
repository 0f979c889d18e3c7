#include "core/motion/border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

/// How a beam runs outwards from its point of the contour's surface: 1, and these.
struct Slope {
  double b, a;
};

/// Where the beam through a point of the contour's surface meets the surface of radius `rho`. One
/// that grazes past it: its nearest place.
Flat on_surface(const PartBorder& part, const CutPoint& p, Slope tan, double rho) {
  const double radius = part.cut.radius;
  if (tan.a == 0.0) return {rho * p.phi, p.z - part.sigma * (rho - radius) * tan.b};
  // Down by h: (r - h)^2 + (h tan a)^2 = rho^2.
  const double square = 1.0 + tan.a * tan.a;
  const double between = radius * radius - rho * rho;
  const double root = std::max(0.0, radius * radius - square * between);
  const double h = between / (radius + std::sqrt(root));
  const double turned = elementary::atan2(h * tan.a, radius - h);
  return {rho * (p.phi - turned), p.z + part.sigma * h * tan.b};
}

Slope slope_of(const PartBorder& part, std::size_t i) {
  return {part.tan_b[i], part.tan_a.empty() ? 0.0 : part.tan_a[i]};
}

/// No more than the distance to the chord from a to b.
double least_distance(Flat p, Flat a, Flat b) {
  const auto [low_s, high_s] = std::minmax(a.s, b.s);
  const auto [low_z, high_z] = std::minmax(a.z, b.z);
  return std::max({low_s - p.s, p.s - high_s, low_z - p.z, p.z - high_z});
}

bool crosses_above(Flat p, Flat a, Flat b) {
  if ((a.s <= p.s) == (b.s <= p.s)) return false;
  return a.z + (b.z - a.z) * (p.s - a.s) / (b.s - a.s) > p.z;
}

/// Signed distance to the border on one surface: positive inside the kept part.
double depth(const PartBorder& part, const CutPoint& point, Slope tan, double rho,
             const std::stop_token& stop) {
  const Flat p = on_surface(part, point, tan, rho);
  double nearest = 1e300;
  bool odd = false;
  Flat a = on_surface(part, part.cut.points.front(), slope_of(part, 0), rho);
  for (std::size_t i = 1; i < part.cut.points.size() && !stops(stop, i); ++i) {
    const Flat b = on_surface(part, part.cut.points[i], slope_of(part, i), rho);
    if (least_distance(p, a, b) < nearest) nearest = std::min(nearest, distance(p, a, b));
    odd = odd != crosses_above(p, a, b);
    a = b;
  }
  const bool kept = part.scrap == Scrap::plus_z ? odd : !odd;
  return kept ? nearest : -nearest;
}

/// The point turned by whole turns into the span of the border.
CutPoint wrapped(const PartBorder& part, CutPoint p) {
  p.phi -= kTwoPi * std::floor((p.phi - part.from_phi) / kTwoPi);
  return p;
}

/// One turn of a ring seen from a point near its seam needs the neighbouring turn for the distance.
double depth_on_ring(const PartBorder& part, const CutPoint& p, Slope tan, double rho,
                     const std::stop_token& stop) {
  const double here = depth(part, p, tan, rho, stop);
  if (part.cut.turns == 0) return here;
  double nearest = std::abs(here);
  for (const double turn : {-kTwoPi, kTwoPi}) {
    CutPoint moved = p;
    moved.phi += turn;
    nearest = std::min(nearest, std::abs(depth(part, moved, tan, rho, stop)));
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
class BorderCurve {
 public:
  explicit BorderCurve(const Track& track) : track_(track) {
    for (const CutPoint& p : track.points) {
      spots_.push_back({track.radius * p.phi, p.z, p.b});
    }
  }

  /// Segment `i` at share `w`.
  [[nodiscard]] CutPoint at(std::size_t i, double w) const {
    const double l = length(i);
    const Spot start = tangent(i, i), end = tangent(i + 1, i);
    const double v = 1.0 - w;
    const Spot ends =
        mixed(v * v * (1.0 + 2.0 * w), spots_[i], w * w * (3.0 - 2.0 * w), spots_[i + 1]);
    const Spot bends = mixed(l * w * v * v, start, -l * w * w * v, end);
    const Spot x = mixed(1.0, ends, 1.0, bends);
    const double a = v * track_.points[i].a + w * track_.points[i + 1].a;
    return {x[0] / track_.radius, x[1], x[2], false, 0.0, a};
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

/// A closed track with points of the smooth curve through its own put between them, and how far its
/// own chords leave it.
struct SmoothTrack {
  Track track = {};
  double sag = 0.0;  // mm
};

SmoothTrack smooth_border(const Track& track) {
  constexpr double kSag = 0.002;  // mm
  constexpr double kMostPieces = 32.0;
  SmoothTrack out{track, 0.0};
  if (!track.closed) return out;
  const BorderCurve curve(track);
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

}  // namespace

double distance(Flat p, Flat a, Flat b) {
  const double s = b.s - a.s, z = b.z - a.z;
  const double square = s * s + z * z;
  const double along = square > 0.0 ? ((p.s - a.s) * s + (p.z - a.z) * z) / square : 0.0;
  const double k = std::clamp(along, 0.0, 1.0);
  return elementary::hypot(p.s - a.s - k * s, p.z - a.z - k * z);
}

Result<PartBorder> part_border(const CutPath& cut_path, double sigma) {
  auto whole = track(cut_path);
  if (!whole) return tl::unexpected<Error>(whole.error());
  SmoothTrack border = smooth_border(*whole);
  const auto& points = border.track.points;
  const auto [low, high] = std::ranges::minmax(points, {}, &CutPoint::phi);
  const double from = border.track.turns == 0 ? 0.5 * (low.phi + high.phi) - kPi : low.phi;
  std::vector<double> tan_b(points.size());
  std::ranges::transform(points, tan_b.begin(),
                         [](const CutPoint& p) { return elementary::tan(p.b); });
  std::vector<double> tan_a(cut_path.a.empty() ? 0 : points.size());
  for (std::size_t i = 0; i < tan_a.size(); ++i) tan_a[i] = elementary::tan(points[i].a);
  return PartBorder{.cut = std::move(border.track),
                    .scrap = cut_path.scrap,
                    .outer_radius = cut_path.outer_radius,
                    .inner_radius = cut_path.inner_radius(),
                    .sigma = sigma,
                    .sag = border.sag,
                    .tan_b = std::move(tan_b),
                    .tan_a = std::move(tan_a),
                    .from_phi = from};
}

Flat on_wall(const PartBorder& part, const CutPoint& p, double rho) {
  return on_surface(part, p, {elementary::tan(p.b), p.a == 0.0 ? 0.0 : elementary::tan(p.a)}, rho);
}

double intrusion(const PartBorder& part, const CutPoint& point, const std::stop_token& stop) {
  const CutPoint p = wrapped(part, point);
  const Slope tan{elementary::tan(p.b), p.a == 0.0 ? 0.0 : elementary::tan(p.a)};
  const double middle = 0.5 * (part.inner_radius + part.outer_radius);
  double deepest = -1e300;
  for (const double rho : {part.inner_radius, middle, part.outer_radius}) {
    deepest = std::max(deepest, depth_on_ring(part, p, tan, rho, stop));
  }
  return deepest;
}

}  // namespace tubecut::motion
