#include "core/motion/lead.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr double kArcStep = 3.0 * kRadPerDeg;  // between points of a lead arc
constexpr double kRunStep = 0.5;               // mm between points of a straight run

/// A point or direction of a developed surface: s = radius * phi, and z.
struct Flat {
  double s = 0.0;
  double z = 0.0;
};
Flat operator+(Flat a, Flat b) { return {a.s + b.s, a.z + b.z}; }
Flat operator*(double k, Flat a) { return {k * a.s, k * a.z}; }

struct Join {
  CutPoint at;
  Flat point;
  Flat tangent;
  Flat normal;  // unit, towards the scrap
};

Flat flat(const Track& t, const CutPoint& p) { return {t.radius * p.phi, p.z}; }

Flat unit(Flat a) {
  const double length = elementary::hypot(a.s, a.z);
  return length > 0.0 ? (1.0 / length) * a : Flat{1.0, 0.0};
}

/// First direction with a length going from point `i` by `by`; a pure swing of B has none.
Flat chord(const Track& t, std::size_t i, int by) {
  const auto last = static_cast<std::ptrdiff_t>(t.points.size()) - 1;
  for (auto j = static_cast<std::ptrdiff_t>(i) + by; j >= 0 && j <= last; j += by) {
    const auto to = static_cast<std::size_t>(j);
    if (t.tip_step(i, to) > 0.0) return flat(t, t.points[to]) + -1.0 * flat(t, t.points[i]);
  }
  return {};
}

/// Tangent in the middle of a smooth seam (parabola through three points), of the cut's own side at
/// a corner.
Flat tangent(const Track& t, Flat before, Flat after, bool starting) {
  const double a = elementary::hypot(before.s, before.z);
  const double b = elementary::hypot(after.s, after.z);
  const Flat own = starting ? after : before;
  const bool smooth = t.closed && !t.points.front().corner &&
                      before.s * after.s + before.z * after.z > 0.94 * a * b;
  return unit(smooth ? (b / a) * before + (a / b) * after : own);
}

Flat scrap_normal(Flat t, int orientation, Scrap scrap) {
  const Flat left{-t.z, t.s};
  if (scrap == Scrap::inside) return orientation * left;
  return (scrap == Scrap::plus_z ? orientation : -orientation) * left;
}

/// Direction along the track just before point `i`; none at the start of an open one.
Flat behind(const Track& t, std::size_t i) {
  if (i == 0 && !t.closed) return {};
  return -1.0 * chord(t, i == 0 ? t.points.size() - 1 : i, -1);
}

Join join(const Track& t, Scrap scrap, std::size_t i, bool starting) {
  const Flat before = behind(t, i);
  const Flat after = i + 1 == t.points.size() ? before : chord(t, i, 1);
  const bool start = i == 0 && !t.closed;
  const Flat along = tangent(t, start ? after : before, after, starting);
  return {t.points[i], flat(t, t.points[i]), along, scrap_normal(along, t.orientation(), scrap)};
}

/// A point `a` rad round the arc from the join; `way` is -1 before the join, +1 behind it.
Flat on_arc(const Join& j, double radius, double a, double way) {
  const auto [sin, cos] = elementary::sincos(a);
  return j.point + radius * (1.0 - cos) * j.normal + way * radius * sin * j.tangent;
}

/// The arc's points away from the join, nearest first, and their distances from it along the path.
struct Away {
  std::vector<Flat> points;
  std::vector<double> distance;
};

Away arc(const Join& j, const Lead& lead, double way) {
  Away out;
  const double sweep = lead.sweep.rad();
  const auto n = std::max(1, static_cast<int>(std::ceil(sweep / kArcStep)));
  for (int i = 1; i <= n; ++i) {
    out.points.push_back(on_arc(j, lead.radius, sweep * i / n, way));
    out.distance.push_back(lead.radius * sweep * i / n);
  }
  return out;
}

/// Lengthens the way in straight until the fan of B fits before the cut.
void add_run(Away& way_in, const Join& j, const Lead& lead) {
  const double run = lead.fan - way_in.distance.back();
  if (!lead.pierce_b || run <= 0.0) return;
  const auto [sin, cos] = elementary::sincos(lead.sweep.rad());
  const Flat back = sin * j.normal + -cos * j.tangent;
  const Flat from = way_in.points.back();
  const double start = way_in.distance.back();
  const auto n = std::max(1, static_cast<int>(std::ceil(run / kRunStep)));
  for (int i = 1; i <= n; ++i) {
    way_in.points.push_back(from + (run * i / n) * back);
    way_in.distance.push_back(start + run * i / n);
  }
}

/// B and the beam's way through the wall.
struct Line {
  double b, beam;
};

/// What a closed cut has this far past its start, mm, or before it: no further than to where it
/// turns a corner or swings on the spot.
Line line_of(const Track& cut, double past_start) {
  const auto n = cut.points.size();
  const bool back = past_start < 0.0;
  const auto index = [&](std::size_t k) { return back ? n - 1 - k : k; };
  double left = std::abs(past_start);
  Line out{cut.points.front().b, cut.points.front().beam};
  for (std::size_t k = 0; k + 1 < n && left > 0.0; ++k) {
    const auto &from = cut.points[index(k)], &to = cut.points[index(k + 1)];
    const double step = cut.tip_step(index(k), index(k + 1));
    if (step == 0.0 || (k > 0 && from.corner)) break;
    const double u = std::min(1.0, left / step);
    out = {from.b + u * (to.b - from.b), from.beam + u * (to.beam - from.beam)};
    left -= step;
  }
  return out;
}

/// Of the lead's place this far past the cut's start, or before it.
Line line_of(const Track& cut, const Join& j, LeadBevel bevel, double past_start) {
  const bool held = bevel == LeadBevel::held || !cut.closed;
  return held ? Line{j.at.b, j.at.beam} : line_of(cut, past_start);
}

CutPoint placed(const Track& t, Flat p, Line line) {
  return {p.s / t.radius, p.z, line.b, false, line.beam};
}

std::vector<CutPoint> way_in(const Track& t, const Join& j, const Lead& lead, LeadBevel bevel) {
  Away way = arc(j, lead, -1.0);
  add_run(way, j, lead);
  const double fan = std::min(lead.fan, way.distance.back());
  const Line first = line_of(t, j, bevel, -way.distance.back());
  const double most = lead.pierce_b ? lead.pierce_b->rad() : std::abs(first.b);
  const double pierce = std::clamp(first.b, -most, most);
  std::vector<CutPoint> out;
  for (std::size_t i = way.points.size(); i-- > 0;) {
    CutPoint p = placed(t, way.points[i], line_of(t, j, bevel, -way.distance[i]));
    const double done =
        fan > 0.0 ? std::min(1.0, (way.distance.back() - way.distance[i]) / fan) : 1.0;
    p.b += (1.0 - done) * (pierce - first.b);
    out.push_back(p);
  }
  return out;
}

/// Where the beam through a point of the contour's surface meets the surface of radius `rho`.
Flat on_surface(const PartBorder& part, const CutPoint& p, double tan_b, double rho) {
  return {rho * p.phi, p.z - part.sigma * (rho - part.cut.radius) * tan_b};
}

/// No more than the distance to the chord from a to b.
double least_distance(Flat p, Flat a, Flat b) {
  const auto [low_s, high_s] = std::minmax(a.s, b.s);
  const auto [low_z, high_z] = std::minmax(a.z, b.z);
  return std::max({low_s - p.s, p.s - high_s, low_z - p.z, p.z - high_z});
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
double depth(const PartBorder& part, const CutPoint& point, double tan_b, double rho,
             const std::stop_token& stop) {
  const Flat p = on_surface(part, point, tan_b, rho);
  double nearest = 1e300;
  bool odd = false;
  Flat a = on_surface(part, part.cut.points.front(), part.tan_b.front(), rho);
  for (std::size_t i = 1; i < part.cut.points.size() && !stops(stop, i); ++i) {
    const Flat b = on_surface(part, part.cut.points[i], part.tan_b[i], rho);
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
double depth_on_ring(const PartBorder& part, const CutPoint& p, double tan_b, double rho,
                     const std::stop_token& stop) {
  const double here = depth(part, p, tan_b, rho, stop);
  if (part.cut.turns == 0) return here;
  double nearest = std::abs(here);
  for (const double turn : {-kTwoPi, kTwoPi}) {
    CutPoint moved = p;
    moved.phi += turn;
    nearest = std::min(nearest, std::abs(depth(part, moved, tan_b, rho, stop)));
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

CutWithLead with_lead(const Track& cut, const Lead& lead, Scrap scrap, LeadBevel bevel) {
  Track t = cut;
  if (t.closed) {
    std::vector<CutPoint> again = first_stretch(cut, lead.overcut);
    for (auto p = again.begin() + 1; p != again.end(); ++p) {
      p->phi += kTwoPi * cut.turns;
      t.points.push_back(*p);
    }
  }
  CutWithLead out;
  out.points = way_in(cut, join(cut, scrap, 0, true), lead, bevel);
  out.cut_first = out.points.size();
  out.points.insert(out.points.end(), t.points.begin(), t.points.end());
  out.cut_last = out.points.size() - 1;
  const Join end = join(t, scrap, t.points.size() - 1, false);
  const Away way = arc(end, lead, 1.0);
  for (std::size_t i = 0; i < way.points.size(); ++i)
    out.points.push_back(
        placed(t, way.points[i], line_of(cut, end, bevel, lead.overcut + way.distance[i])));
  return out;
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
  return PartBorder{.cut = std::move(border.track),
                    .scrap = cut_path.scrap,
                    .outer_radius = cut_path.outer_radius,
                    .inner_radius = cut_path.inner_radius(),
                    .sigma = sigma,
                    .sag = border.sag,
                    .tan_b = std::move(tan_b),
                    .from_phi = from};
}

double intrusion(const PartBorder& part, const CutPoint& point, const std::stop_token& stop) {
  const CutPoint p = wrapped(part, point);
  const double tan_b = elementary::tan(p.b);
  const double middle = 0.5 * (part.inner_radius + part.outer_radius);
  double deepest = -1e300;
  for (const double rho : {part.inner_radius, middle, part.outer_radius}) {
    deepest = std::max(deepest, depth_on_ring(part, p, tan_b, rho, stop));
  }
  return deepest;
}

double lead_touch(const PartBorder& border, double eps_tip) {
  return kLeadTouch + std::min(border.sag, eps_tip);
}

Result<void> check_clear(const CutWithLead& cut, const PartBorder& part, double eps_tip,
                         const std::stop_token& stop) {
  if (!part.cut.closed) return {};
  const double allowed = lead_touch(part, eps_tip);
  for (std::size_t i = 0; i < cut.points.size(); ++i) {
    if (i >= cut.cut_first && i <= cut.cut_last) continue;
    const CutPoint& p = cut.points[i];
    const double depth = intrusion(part, p, stop);
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    if (depth <= allowed) continue;
    return fail({ErrorCode::lead_blocked, "motion/lead", depth, allowed, "mm",
                 "at phi " + brief(p.phi * kDegPerRad) + " deg"});
  }
  return {};
}

}  // namespace tubecut::motion
