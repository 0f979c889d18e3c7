#include "core/motion/path/border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::motion {
namespace {

/// The direction of a beam outwards from its point of the contour's surface: 1, and these tangents.
struct Slope {
  double b, a;
};

/// Computes where the beam through a point of the contour's surface meets the surface of radius
/// `rho`. If it misses, returns its nearest point.
Flat on_surface(const PartBorder& part, const CutPoint& p, Slope tan, double rho) {
  const double radius = part.cut.radius;
  const double developed = part.cut.section ? radius : rho;
  if (tan.a == 0.0) return {developed * p.phi, p.z - part.sigma * (rho - radius) * tan.b};
  // Down by h: (r - h)^2 + (h tan a)^2 = rho^2.
  const double square = 1.0 + tan.a * tan.a;
  const double between = radius * radius - rho * rho;
  const double root = std::max(0.0, radius * radius - square * between);
  const double h = between / (radius + std::sqrt(root));
  const double turned = elementary::atan2(h * tan.a, radius - h);
  return {rho * (p.phi - turned), p.z + part.sigma * h * tan.b};
}

Slope slope_of(const CutPoint& p) {
  return {elementary::tan(p.b), p.a == 0.0 ? 0.0 : elementary::tan(p.a)};
}

/// Computes the border where its beams meet the surface of radius `rho`.
BorderWall wall_of(const PartBorder& part, double rho) {
  std::vector<Flat> line(part.cut.points.size());
  std::ranges::transform(part.cut.points, line.begin(),
                         [&](const CutPoint& p) { return on_wall(part, p, rho); });
  return {rho, Chords(std::move(line))};
}

bool crosses_above(Flat p, Flat a, Flat b) {
  if ((a.s <= p.s) == (b.s <= p.s)) return false;
  return a.z + (b.z - a.z) * (p.s - a.s) / (b.s - a.s) > p.z;
}

/// Computes the signed distance to the border on one surface: positive inside the kept part. Boxes
/// that are too far away to contain the nearest chord, and are neither above nor below the point,
/// are skipped.
double depth(const PartBorder& part, const CutPoint& point, Slope tan, const BorderWall& wall) {
  const Flat p = on_surface(part, point, tan, wall.rho);
  const auto& boxes = wall.line.boxes;
  double bound = 1e300, nearest = 1e300;
  for (const auto& box : boxes) bound = std::min(bound, most_distance(p, box));
  bool odd = false;
  for (std::size_t k = 0; k < boxes.size() && !stopped(); ++k) {
    const bool beside = p.s < boxes[k].low.s || boxes[k].high.s < p.s;
    if (beside && least_distance(p, boxes[k]) > bound) continue;
    each_chord(wall.line, k, [&](Flat a, Flat b) {
      nearest = nearer(nearest, p, a, b);
      odd = odd != crosses_above(p, a, b);
    });
  }
  const bool kept = part.scrap == Scrap::plus_z ? odd : !odd;
  return kept ? nearest : -nearest;
}

/// Shifts the point by whole revolutions into the span of the border.
CutPoint wrapped(const PartBorder& part, CutPoint p) {
  p.phi -= kTwoPi * std::floor((p.phi - part.from_phi) / kTwoPi);
  return p;
}

/// Computes the depth with the neighbouring revolutions, because a point near the seam of a ring
/// may be nearest to one of them.
double depth_on_ring(const PartBorder& part, const CutPoint& p, Slope tan, const BorderWall& wall) {
  const double here = depth(part, p, tan, wall);
  if (part.cut.turns == 0) return here;
  double nearest = std::abs(here);
  for (const double turn : {-kTwoPi, kTwoPi}) {
    CutPoint moved = p;
    moved.phi += turn;
    nearest = std::min(nearest, std::abs(depth(part, moved, tan, wall)));
  }
  return here < 0.0 ? -nearest : nearest;
}

/// A point of a track as (s, z, b), and differences of such points.
using Spot = std::array<double, 3>;

Spot mixed(double p, const Spot& a, double q, const Spot& b) {
  return {p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2]};
}

double tip_length(const Spot& a) { return elementary::hypot(a[0], a[1]); }

/// Returns true where a flat of the section meets a corner. The cut's curvature jumps there, so a
/// tangent of both sides would bend the curve off the long chord of the flat.
bool is_at_seam(const section::Section& section, double s) {
  constexpr double kSame = 1e-6;  // mm
  const auto outside = section.outer();
  return std::ranges::any_of(outside.seams(), [&](double seam) {
    return std::abs(std::remainder(s - seam, outside.girth())) < kSame;
  });
}

/// Chords of a closed track, segment by segment, and the tangents per mm of the tip at their ends.
class BorderCurve {
 public:
  explicit BorderCurve(const Track& track) : track_(track) {
    for (const CutPoint& p : track.points) {
      spots_.push_back({track.radius * p.phi, p.z, p.b});
      seam_.push_back(track.section && is_at_seam(*track.section, spots_.back()[0]));
    }
  }

  /// Returns the point of segment `i` at the fraction `w`.
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

  /// Returns the distance of segment `i`'s chord to the curve in its middle.
  [[nodiscard]] double sag(std::size_t i) const {
    if (length(i) == 0.0) return 0.0;
    return 0.125 * length(i) * tip_length(mixed(1.0, tangent(i, i), -1.0, tangent(i + 1, i)));
  }

 private:
  static constexpr double kCorner = 0.94;  // cosine of 20 deg
  static constexpr double kUneven = 2.0;   // between the lengths of two chords

  [[nodiscard]] std::size_t segments() const { return spots_.size() - 1; }
  [[nodiscard]] Spot chord(std::size_t i) const {
    return mixed(1.0, spots_[i + 1], -1.0, spots_[i]);
  }
  [[nodiscard]] double length(std::size_t i) const { return tip_length(chord(i)); }
  [[nodiscard]] Spot slope(std::size_t i) const {
    return mixed(1.0 / length(i), chord(i), 0.0, {});
  }

  /// Returns the tangent at knot `k` for the adjacent segment `own`.
  [[nodiscard]] Spot tangent(std::size_t k, std::size_t own) const {
    const std::size_t before = before_of(k), after = after_of(k);
    if (length(before) == 0.0 || length(after) == 0.0 || is_marked(k)) return slope(own);
    const Spot m = slope(before), n = slope(after);
    if (is_sharp(m, n)) return slope(own);
    const double share = share_before(k);
    return mixed(1.0 - share, m, share, n);
  }

  [[nodiscard]] std::size_t before_of(std::size_t k) const {
    return k == 0 ? segments() - 1 : k - 1;
  }
  [[nodiscard]] std::size_t after_of(std::size_t k) const { return k == segments() ? 0 : k; }
  [[nodiscard]] bool is_marked(std::size_t k) const { return track_.points[k].corner || seam_[k]; }
  [[nodiscard]] static bool is_sharp(const Spot& m, const Spot& n) {
    return m[0] * n[0] + m[1] * n[1] < kCorner;
  }

  /// Returns the turn of the chords at knot `k`, to the left; 0 where a chord has no length.
  [[nodiscard]] double turn(std::size_t k) const {
    const std::size_t before = before_of(k), after = after_of(k);
    if (length(before) == 0.0 || length(after) == 0.0) return 0.0;
    const Spot m = slope(before), n = slope(after);
    return elementary::atan2(m[0] * n[1] - m[1] * n[0], m[0] * n[0] + m[1] * n[1]);
  }

  /// Returns the fraction of the turn at knot `k` that the curve makes before it: that of the
  /// parabola through three points, unless one chord is much longer than the other.
  [[nodiscard]] double share_before(std::size_t k) const {
    const double a = length(before_of(k)), b = length(after_of(k));
    if (a > kUneven * b) return share_of_longer(before_of(k), k, after_of(k));
    if (b > kUneven * a) return 1.0 - share_of_longer(after_of(k), k, before_of(k));
    return a / (a + b);
  }

  /// Returns the fraction of the turn at knot `k` along the longer of its two chords. A straight
  /// edge next to an arc has one long chord next to short ones, and the parabola would bend it. So
  /// the curvature comes from one side: from the longer chord's other end if the chord there is not
  /// short too, else from the shorter chord's if the one there is as short. Without either, the two
  /// chords deviate from the curve by the same.
  [[nodiscard]] double share_of_longer(std::size_t longer, std::size_t k,
                                       std::size_t shorter) const {
    const double here = turn(k), a = length(longer), b = length(shorter);
    if (here == 0.0) return 0.0;
    const auto beyond = [&](std::size_t chord) {
      const bool forwards = chord == after_of(k);
      const std::size_t knot = forwards ? chord + 1 : chord;
      return std::pair{knot, forwards ? after_of(knot) : before_of(knot)};
    };
    const auto part = [&](double of, double next, std::size_t knot) {
      return of * turn(knot) / ((of + next) * here);
    };
    const auto [far, last] = beyond(longer);
    if (!is_marked(far) && kUneven * length(last) >= a && !is_sharp(slope(longer), slope(last)))
      return std::clamp(part(a, length(last), far), 0.0, 1.0);
    const auto [near, next] = beyond(shorter);
    const double c = length(next), own = part(b, c, near);
    const bool alike = c <= kUneven * b && b <= kUneven * c;
    if (!is_marked(near) && alike && own > 0.0) return 1.0 - std::min(1.0, own);
    return b / (a + b);
  }

  const Track& track_;
  std::vector<Spot> spots_;
  std::vector<bool> seam_;
};

/// A closed track with inserted points of the smooth curve through its own points, and the largest
/// distance of its own chords to that curve.
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
  for (std::size_t i = 0; i + 1 < track.points.size() && !stops(i); ++i) {
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

Result<PartBorder> part_border(const CutPath& cut_path, double sigma) {
  TRY(const auto whole, track(cut_path));
  SmoothTrack border = smooth_border(whole);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  const auto& points = border.track.points;
  const auto [low, high] = std::ranges::minmax(points, {}, &CutPoint::phi);
  const double from = border.track.turns == 0 ? 0.5 * (low.phi + high.phi) - kPi : low.phi;
  PartBorder out{.cut = std::move(border.track),
                 .scrap = cut_path.scrap,
                 .outer_radius = cut_path.outer_radius,
                 .inner_radius = cut_path.inner_radius(),
                 .sigma = sigma,
                 .sag = border.sag,
                 .from_phi = from};
  const double middle = 0.5 * (out.inner_radius + out.outer_radius);
  for (const double rho : {out.inner_radius, middle, out.outer_radius})
    if (!stopped()) out.walls.push_back(wall_of(out, rho));
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

Flat on_wall(const PartBorder& part, const CutPoint& p, double rho) {
  return on_surface(part, p, slope_of(p), rho);
}

double intrusion(const PartBorder& part, const CutPoint& point) {
  const CutPoint p = wrapped(part, point);
  const Slope tan = slope_of(p);
  double deepest = -1e300;
  for (const auto& wall : part.walls)
    deepest = std::max(deepest, depth_on_ring(part, p, tan, wall));
  return deepest;
}

}  // namespace tubecut::motion
