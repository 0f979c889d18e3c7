#include "core/joint/cutters/elbow.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/elementary.hpp"
#include "core/joint/cutters/convex.hpp"
#include "core/joint/cutters/elbow_leg.hpp"
#include "core/joint/node/sheets.hpp"
#include "core/joint/trig_roots.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 400;
constexpr double kOnSurface = 1e-14;  // relative
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kScan = 720;
/// An elbow is not convex, so its section is scanned across the wall and refined around the
/// steepest point. The table's own verification, not this scan, finds features between the samples.
constexpr int kAcross = 33;

/// One segment of the centre line near a point: its nearest point, and a bound of the curvature of
/// the distance along a line.
struct Near {
  Vector3d foot;
  double distance;
  bool arc;
};

Near near_leg(const Vector3d& p, const Vector3d& from, const Vector3d& along) {
  const Vector3d foot = from + std::max(0.0, (p - from).dot(along)) * along;
  return {foot, (p - foot).norm(), false};
}

struct Legs {
  Vector3d start, end, end_along;
};

Legs legs(const PreparedElbow& e) {
  const Vector3d end(e.end.x() * e.bend_radius, e.end.y() * e.bend_radius, 0.0);
  return {{e.bend_radius, 0.0, 0.0}, end, {-e.end.y(), e.end.x(), 0.0}};
}

/// A leg: the point where it leaves the bend, and its direction.
struct Leg {
  Vector3d from, along;
};
std::array<Leg, 2> each_leg(const PreparedElbow& e) {
  const auto l = legs(e);
  return {Leg{l.start, -Vector3d::UnitY()}, Leg{l.end, l.end_along}};
}

bool runs_along(const PreparedElbow& e, const Leg& leg) {
  return e.rise.cross(leg.along).norm() < kAlongTarget;
}

bool in_sector(const PreparedElbow& e, const Vector3d& p) {
  return p.y() >= 0.0 && p.x() * e.end.y() - p.y() * e.end.x() >= 0.0;
}

Near near_circle(const PreparedElbow& e, const Vector3d& p) {
  const double r = elementary::hypot(p.x(), p.y());
  const Vector3d foot(p.x() * e.bend_radius / r, p.y() * e.bend_radius / r, 0.0);
  return {foot, elementary::hypot(r - e.bend_radius, p.z()), true};
}

/// The segments of the centre line; the arc is present if the point faces it.
struct NearParts {
  std::array<Near, 3> all;
  std::size_t count;
  [[nodiscard]] const Near& nearest() const {
    return *std::min_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count),
                             [](const Near& a, const Near& b) { return a.distance < b.distance; });
  }
};

NearParts near_parts(const PreparedElbow& e, const Legs& l, const Vector3d& p) {
  NearParts out{{near_leg(p, l.start, -Vector3d::UnitY()), near_leg(p, l.end, l.end_along), {}}, 2};
  if (!in_sector(e, p)) return out;
  if (!(elementary::hypot(p.x(), p.y()) > 0.0)) return out;
  out.all[2] = near_circle(e, p);
  out.count = 3;
  return out;
}

/// Returns a step down from p within which the line cannot reach this segment's surface. The
/// distance to a straight leg is convex along the line; that to the arc has a second derivative of
/// at most 2 / (R - r) while the line stays halfway from the bend's axis.
double free_way(const PreparedElbow& e, const Vector3d& p, const Near& near) {
  const double gap = near.distance - e.radius;
  const double falling = near.distance > 0.0 ? (p - near.foot).dot(e.rise) / near.distance : 1.0;
  if (!near.arc) return falling > 0.0 ? gap / falling : kInfinity;
  const double room = 0.5 * (e.bend_radius - e.radius);
  const double bend = 1.0 / room;
  const double way =
      2.0 * gap / (falling + std::sqrt(std::max(0.0, falling * falling + 2.0 * bend * gap)));
  return std::max(gap, std::min(way, room - gap));
}

/// The same for the arc from a point that does not face it: no nearer than its two ends, and no
/// nearer than the whole circle.
double free_way_aside(const PreparedElbow& e, const Legs& l, const Vector3d& p) {
  const double ends = std::min((p - l.start).norm(), (p - l.end).norm()) - e.radius;
  const double r = elementary::hypot(p.x(), p.y());
  if (!(r > 0.0)) return ends;
  const auto circle = near_circle(e, p);
  return circle.distance > e.radius ? std::max(ends, free_way(e, p, circle)) : ends;
}

Vector3d foot_of(const PreparedElbow& e, const Generator& g) {
  return e.rows * (Vector3d(g.radius * g.cos_phi, g.radius * g.sin_phi, 0.0) - e.center);
}

/// Returns the two heights between which the line can meet the elbow: within reach of the bend, or
/// of a leg's whole cylinder. For a leg along the line, the reach is `leg_reach`.
std::array<double, 2> range(const PreparedElbow& e, const Vector3d& o) {
  const double reach = e.bend_radius + e.radius;
  const double middle = -o.dot(e.rise);
  std::array<double, 2> out{middle - reach, middle + reach};
  for (const auto& leg : each_leg(e)) {
    if (runs_along(e, leg)) {
      const double far = leg_reach(e.radius, e.bend_radius);
      if (leg.along.dot(e.rise) > 0.0)
        out[1] = std::max(out[1], middle + far);
      else
        out[0] = std::min(out[0], middle - far);
      continue;
    }
    const Vector3d v = o - leg.from;
    const Vector3d across = e.rise - e.rise.dot(leg.along) * leg.along;
    const double a = across.squaredNorm();
    const double z = -v.dot(across) / a;
    const double half = e.radius / std::sqrt(a);
    out = {std::min(out[0], z - half), std::max(out[1], z + half)};
  }
  return out;
}

/// The point of a line that is nearest to the elbow's centre line.
struct Approach {
  double clearance = kInfinity;  // < 0 if the line enters the elbow
  double z = 0.0;
};

/// Finds the angles around the bend at which its distance from the line o + z rise may have a
/// minimum: zeros of the derivative of -2 c.o - (c.rise)^2 with c = bend radius (cos, sin, 0).
/// o must be perpendicular to rise.
RootPhases nearest_angles(const PreparedElbow& e, const Vector3d& o) {
  const double x = e.rise.x(), y = e.rise.y(), r = e.bend_radius;
  const double cos1 = -o.y(), sin1 = o.x(), cos2 = -r * x * y, sin2 = -0.5 * r * (y - x) * (y + x);
  Trig<2> slope;
  slope.c = {Complex{0.5 * cos2, 0.5 * sin2}, Complex{0.5 * cos1, 0.5 * sin1}, Complex{},
             Complex{0.5 * cos1, -0.5 * sin1}, Complex{0.5 * cos2, -0.5 * sin2}};
  return root_phases(slope);
}

/// Computes the exact distance of the line o + z rise from the elbow: of the legs by
/// perpendiculars, of the arc at the zeros of the distance's derivative. If several points are
/// equally near within `touch`, or several touch, z is that of the highest, because the upper sheet
/// ends there.
Approach closest(const PreparedElbow& e, const Vector3d& o, double touch) {
  std::array<Approach, 2 + RootPhases::kMost> places{};
  std::size_t count = 0;
  double least = kInfinity;
  const auto consider = [&](const Vector3d& at) {
    const Vector3d v = at - o;
    const double z = v.dot(e.rise);
    const double clearance = (v - z * e.rise).norm() - e.radius;
    least = std::min(least, clearance);
    places[count++] = {clearance, z};
  };
  for (const auto& leg : each_leg(e)) {
    const Vector3d across = leg.along - leg.along.dot(e.rise) * e.rise;
    const double far = runs_along(e, leg) ? leg_reach(e.radius, e.bend_radius) : kInfinity;
    const double share =
        across.squaredNorm() > 0.0 ? (o - leg.from).dot(across) / across.squaredNorm() : 0.0;
    consider(leg.from + std::clamp(share, 0.0, far) * leg.along);
  }
  for (const auto& angle : nearest_angles(e, o - o.dot(e.rise) * e.rise)) {
    const auto at = elementary::sincos(angle.phi);
    const Vector3d c(e.bend_radius * at.cos, e.bend_radius * at.sin, 0.0);
    if (in_sector(e, c)) consider(c);
  }
  const double near = std::max(least, 0.0) + touch;
  Approach out{least, -kInfinity};
  for (const auto& place : std::span(places).first(count))
    if (place.clearance <= near) out.z = std::max(out.z, place.z);
  return out;
}

/// The greatest value over the wall of a generator's heights, -infinity where the elbow is missed.
template <class F>
double greatest_across(const PreparedElbow& elbow, const Wall& wall, const Generator& g,
                       double from, F value) {
  std::vector<double> grid, sampled;
  const auto at = [&](double rho) {
    const auto top = elbow.upper_sheet({rho, g.cos_phi, g.sin_phi});
    return top ? value(rho, *top) : -kInfinity;
  };
  for (int k = 0; k < kAcross; ++k) {
    grid.push_back(from + (wall.outer - from) * k / (kAcross - 1));
    sampled.push_back(at(grid.back()));
  }
  return math::grid_maximum(at, grid, sampled).value;
}

}  // namespace

Result<PreparedElbow> ElbowCutter::prepare() const {
  if (!(radius > 0.0) || !std::isfinite(radius))
    return beyond_limit("outer_diameter", 2.0 * radius, 0.0, "mm");
  if (!(bend_radius > radius) || !std::isfinite(bend_radius))
    return beyond_limit("bend_radius", bend_radius, radius, "mm");
  if (!(bend.rad() > 0.0) || bend.rad() > kPi)
    return beyond_limit("bend", bend.deg(), 180.0, "deg");
  const double length = direction.norm();
  if (!(length > 0.0)) return zero_length("axis");
  const Vector3d y = direction / length;
  const Vector3d across = inwards - inwards.dot(y) * y;
  if (!(inwards.norm() > 0.0)) return zero_length("inwards");
  if (!(across.norm() >= kParallel * inwards.norm()))
    return fail({.code = ErrorCode::bad_reference_direction, .member = "inwards"});
  const Vector3d x = -across.normalized();
  PreparedElbow out;
  out.center = point - bend_radius * x;
  out.rows.row(0) = x;
  out.rows.row(1) = y;
  out.rows.row(2) = x.cross(y);
  out.rise = out.rows.col(2);
  out.radius = radius;
  out.bend_radius = bend_radius;
  const auto at = elementary::sincos(bend.rad());
  out.end = {at.cos, at.sin};
  return out;
}

void ElbowCutter::turn(const TurnAboutAxis& turn) {
  point = turn.by * point;
  direction = turn.by * direction;
  inwards = turn.by * inwards;
}

// ---- on the target's generators

// Uses only the legs that do not run along the target.
double PreparedElbow::sine() const {
  const double first = elementary::hypot(rise.x(), rise.z());
  const double last = rise.cross(legs(*this).end_along).norm();
  double out = 1.0;
  for (const double leg : {first, last})
    if (leg >= kAlongTarget) out = std::min(out, leg);
  return out;
}

// The surface is a circle about the target's axis; the leg is tested where it is out of reach.
std::optional<double> endless_leg(const PreparedElbow& elbow, double rho) {
  const Vector3d o = -(elbow.rows * elbow.center);
  const double far = leg_reach(elbow.radius, elbow.bend_radius);
  for (const auto& leg : each_leg(elbow)) {
    if (!runs_along(elbow, leg) || leg.along.dot(elbow.rise) < 0.0) continue;
    const double off = (leg.from + far * leg.along - o).cross(elbow.rise).norm();
    if (std::abs(off - rho) < elbow.radius) return elbow.rise.cross(leg.along).norm();
  }
  return std::nullopt;
}

ElbowPass PreparedElbow::pass(const Generator& line) const {
  const Vector3d o = foot_of(*this, line);
  const auto l = legs(*this);
  const auto [low, high] = range(*this, o);
  const double size = radius + bend_radius + line.radius;
  ElbowPass out{.met = false, .z = high, .clearance = kInfinity};
  double z = high;
  for (int step = 0; step < kSteps && z >= low; ++step) {
    const Vector3d p = o + z * rise;
    const auto all = near_parts(*this, l, p);
    const double gap = all.nearest().distance - radius;
    if (gap > out.clearance && out.clearance <= kTouch * size)
      break;  // it has touched the upper sheet
    if (gap < out.clearance) {
      out.clearance = gap;
      out.z = z;
    }
    if (gap <= kOnSurface * size) break;
    double way = kInfinity;
    for (std::size_t i = 0; i < all.count; ++i) way = std::min(way, free_way(*this, p, all.all[i]));
    if (all.count == 2) way = std::min(way, free_way_aside(*this, l, p));
    z -= way;
  }
  if (out.clearance > kOnSurface * size) {
    const auto nearest = closest(*this, o, kTouch * size);
    const auto outside = [&](double at) {
      return near_parts(*this, l, o + at * rise).nearest().distance > radius;
    };
    const bool enters = nearest.clearance < 0.0 && nearest.z < z;  // if the steps ran out above it
    out.clearance = nearest.clearance;
    out.z = enters ? math::last_true(outside, z, nearest.z) : nearest.z;
  }
  out.met = out.clearance <= kTouch * size;
  return out;
}

std::optional<double> PreparedElbow::upper_sheet(const Generator& line) const {
  const auto passed = pass(line);
  return passed.met ? std::optional(passed.z) : std::nullopt;
}

Hit PreparedElbow::continued_hit(const Generator& line) const {
  const double z = pass(line).z;
  const Vector3d p = foot_of(*this, line) + z * rise;
  const auto near = near_parts(*this, legs(*this), p).nearest();
  const Vector3d u = (p - near.foot) / near.distance;
  return hit_on({z, u, std::max(0.0, u.dot(rise)), 0.0}, rows, line);
}

Met PreparedElbow::met(double rho) const { return met_between_silhouettes(*this, rho); }

std::vector<Sheets> PreparedElbow::sheets(double /*rho*/) const { return {}; }

// The clearance may also change its sign twice between two phases of the scan. Then it has an
// extremum there, so every extremum next to a sampled one is checked.
std::vector<double> PreparedElbow::silhouettes(double rho) const {
  const double touch = kTouch * (radius + bend_radius + rho);
  const auto clearance = [&](double phi) {
    return closest(*this, foot_of(*this, generator_at(rho, phi)), touch).clearance - touch;
  };
  std::vector<double> out;
  const auto add_border = [&](double a, double b) {
    const bool met = clearance(a) <= 0.0;
    const auto like_first = [&](double t) { return (clearance(a + t * (b - a)) <= 0.0) == met; };
    out.push_back(a + math::last_true(like_first, 0.0, 1.0) * (b - a));
  };
  std::vector<double> scan;
  for (std::size_t k = 0; k <= kScan + 1; ++k)
    scan.push_back(clearance(kTwoPi * static_cast<double>(k) / kScan));
  for (std::size_t k = 0; k < kScan; ++k) {
    const double phi = kTwoPi * static_cast<double>(k) / kScan;
    const double next = phi + kTwoPi / kScan, last = next + kTwoPi / kScan;
    const double side = scan[k + 1] <= 0.0 ? -1.0 : 1.0;
    if ((scan[k] <= 0.0) != (scan[k + 1] <= 0.0)) add_border(phi, next);
    const double before = side * scan[k], here = side * scan[k + 1], after = side * scan[k + 2];
    if (std::min(before, after) < here || std::min(before, after) < 0.0) continue;
    const auto nearest =
        math::golden_maximum([&](double p) { return -side * clearance(p); }, phi, last);
    if ((clearance(nearest.at) <= 0.0) == (side < 0.0)) continue;
    add_border(nearest.at, phi);
    add_border(nearest.at, last);
  }
  return out;
}

// An elbow thicker by `off` bounds the heights of all generators within that distance from above,
// one thinner from below.
Heights PreparedElbow::heights_near(const Generator& line, double off) const {
  const auto height = [&](double thicker) {
    auto other = *this;
    other.radius += thicker;
    return other.upper_sheet(line).value_or(-kInfinity);
  };
  Heights out;
  if (radius + off < bend_radius) out.most = height(off);
  if (radius > off) out.least = height(-off);
  return out;
}

double PreparedElbow::steepest(const Wall& wall, const Generator& g, double z_root) const {
  double best = -kInfinity;
  const auto root = upper_sheet(g);
  if (root && *root >= z_root - kSameHeight * (wall.outer + std::abs(z_root))) {
    const auto n = continued_hit(g).normal;
    best = n.z() > 0.0 ? -n.x() / n.z() : n.x() > 0.0 ? -kInfinity : kInfinity;
  }
  // Nearer to the root, the slope is lost in the rounding of z, and the root's own applies.
  const double from = wall.inner + 1e-4 * (wall.outer - wall.inner);
  return std::max(best, greatest_across(*this, wall, g, from, [&](double rho, double z) {
                    return (z - z_root) / (rho - wall.inner);
                  }));
}

double PreparedElbow::support(const Wall& wall, const Generator& g, double slope) const {
  return greatest_across(*this, wall, g, wall.inner,
                         [&](double rho, double z) { return z - (rho - wall.inner) * slope; });
}

}  // namespace tubecut::joint
