#include "core/joint/elbow.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/elementary.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSteps = 400;
constexpr double kOnSurface = 1e-14;  // relative
constexpr double kInfinity = std::numeric_limits<double>::infinity();

tl::unexpected<Error> refused(std::string_view member, std::string_view field, double got,
                              double limit, std::string unit) {
  return fail({.code = ErrorCode::out_of_range,
               .member = std::string(member) + "/" + std::string(field),
               .got = got,
               .limit = limit,
               .unit = std::move(unit)});
}

/// One stretch of the centre line seen from a point: its nearest point and how the distance from
/// it may bend along a line.
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

bool in_sector(const PreparedElbow& e, const Vector3d& p) {
  return p.y() >= 0.0 && p.x() * e.end.y() - p.y() * e.end.x() >= 0.0;
}

Near near_circle(const PreparedElbow& e, const Vector3d& p) {
  const double r = elementary::hypot(p.x(), p.y());
  const Vector3d foot(p.x() * e.bend_radius / r, p.y() * e.bend_radius / r, 0.0);
  return {foot, elementary::hypot(r - e.bend_radius, p.z()), true};
}

/// The stretches of the centre line; the arc is there where the point faces it.
struct Stretches {
  std::array<Near, 3> all;
  std::size_t count;
  [[nodiscard]] const Near& nearest() const {
    return *std::min_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count),
                             [](const Near& a, const Near& b) { return a.distance < b.distance; });
  }
};

Stretches stretches(const PreparedElbow& e, const Vector3d& p) {
  const auto l = legs(e);
  Stretches out{{near_leg(p, l.start, -Vector3d::UnitY()), near_leg(p, l.end, l.end_along), {}}, 2};
  if (!in_sector(e, p)) return out;
  if (!(elementary::hypot(p.x(), p.y()) > 0.0)) return out;
  out.all[2] = near_circle(e, p);
  out.count = 3;
  return out;
}

/// How far the line may go down from p before this stretch's surface can be reached. Distance from
/// a straight leg is convex along the line; from the arc it bends by at most 2 / (R - r) as long as
/// the line stays halfway from the bend's axis.
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
double free_way_aside(const PreparedElbow& e, const Vector3d& p) {
  const auto l = legs(e);
  const double ends = std::min((p - l.start).norm(), (p - l.end).norm()) - e.radius;
  const double r = elementary::hypot(p.x(), p.y());
  if (!(r > 0.0)) return ends;
  const auto circle = near_circle(e, p);
  return circle.distance > e.radius ? std::max(ends, free_way(e, p, circle)) : ends;
}

Vector3d foot_of(const PreparedElbow& e, const Generator& g) {
  return e.rows * (Vector3d(g.radius * g.cos_phi, g.radius * g.sin_phi, 0.0) - e.center);
}

/// The line's two heights between which it can meet the elbow: in reach of the bend, or of a leg's
/// whole cylinder.
std::array<double, 2> range(const PreparedElbow& e, const Vector3d& o) {
  const auto l = legs(e);
  const double reach = e.bend_radius + e.radius;
  const double middle = -o.dot(e.rise);
  std::array<double, 2> out{middle - reach, middle + reach};
  for (const auto& [from, along] :
       {std::pair{l.start, Vector3d(-Vector3d::UnitY())}, std::pair{l.end, l.end_along}}) {
    const Vector3d v = o - from;
    const Vector3d across = e.rise - e.rise.dot(along) * along;
    const double a = across.squaredNorm();
    const double z = -v.dot(across) / a;
    const double half = e.radius / std::sqrt(a);
    out = {std::min(out[0], z - half), std::max(out[1], z + half)};
  }
  return out;
}

}  // namespace

Result<PreparedElbow> prepare_elbow(const ElbowCutter& elbow, std::string_view member) {
  if (!(elbow.radius > 0.0) || !std::isfinite(elbow.radius))
    return refused(member, "outer_diameter", 2.0 * elbow.radius, 0.0, "mm");
  if (!(elbow.bend_radius > elbow.radius) || !std::isfinite(elbow.bend_radius))
    return refused(member, "bend_radius", elbow.bend_radius, elbow.radius, "mm");
  if (!(elbow.bend.rad() > 0.0) || elbow.bend.rad() > kPi)
    return refused(member, "bend", elbow.bend.deg(), 180.0, "deg");
  const double length = elbow.direction.norm();
  if (!(length > 0.0))
    return fail({.code = ErrorCode::zero_length, .member = std::string(member) + "/axis"});
  const Vector3d y = elbow.direction / length;
  const Vector3d across = elbow.inwards - elbow.inwards.dot(y) * y;
  if (!(elbow.inwards.norm() > 0.0))
    return fail({.code = ErrorCode::zero_length, .member = std::string(member) + "/inwards"});
  if (!(across.norm() >= kParallel * elbow.inwards.norm()))
    return fail(
        {.code = ErrorCode::bad_reference_direction, .member = std::string(member) + "/inwards"});
  const Vector3d x = -across.normalized();
  PreparedElbow out;
  out.center = elbow.point - elbow.bend_radius * x;
  out.rows.row(0) = x;
  out.rows.row(1) = y;
  out.rows.row(2) = x.cross(y);
  out.rise = out.rows.col(2);
  out.radius = elbow.radius;
  out.bend_radius = elbow.bend_radius;
  const auto end = elementary::sincos(elbow.bend.rad());
  out.end = {end.cos, end.sin};
  const double sine = elbow_sine(out);
  if (sine >= kParallel) return out;
  return fail({.code = ErrorCode::parallel_axes,
               .member = std::string(member),
               .got = elementary::asin(std::min(1.0, sine)) * kDegPerRad,
               .limit = elementary::asin(kParallel) * kDegPerRad,
               .unit = "deg"});
}

double elbow_sine(const PreparedElbow& e) {
  return std::min(elementary::hypot(e.rise.x(), e.rise.z()),
                  e.rise.cross(legs(e).end_along).norm());
}

ElbowPass elbow_pass(const PreparedElbow& e, const Generator& line) {
  const Vector3d o = foot_of(e, line);
  const auto [low, high] = range(e, o);
  const double size = e.radius + e.bend_radius + line.radius;
  ElbowPass out{.met = false, .z = high, .clearance = kInfinity};
  double z = high;
  for (int step = 0; step < kSteps && z >= low; ++step) {
    const Vector3d p = o + z * e.rise;
    const auto all = stretches(e, p);
    const double gap = all.nearest().distance - e.radius;
    if (gap < out.clearance) {
      out.clearance = gap;
      out.z = z;
    }
    if (gap <= kOnSurface * size) break;
    double way = kInfinity;
    for (std::size_t i = 0; i < all.count; ++i) way = std::min(way, free_way(e, p, all.all[i]));
    if (all.count == 2) way = std::min(way, free_way_aside(e, p));
    z -= way;
  }
  out.met = out.clearance <= kTouch * size;
  return out;
}

Hit elbow_hit(const PreparedElbow& e, const Generator& line) {
  const double z = elbow_pass(e, line).z;
  const Vector3d p = foot_of(e, line) + z * e.rise;
  const auto near = stretches(e, p).nearest();
  const Vector3d u = (p - near.foot) / near.distance;
  const double r = elementary::hypot(p.x(), p.y());
  const Vector3d t = near.arc ? Vector3d(-p.y() / r, p.x() / r, 0.0)
                     : near.foot.y() <= 0.0 && near.foot.x() == e.bend_radius
                         ? Vector3d(Vector3d::UnitY())
                         : legs(e).end_along;
  const Vector3d v = u.cross(t);
  Matrix3d hessian = v * v.transpose() / near.distance;
  if (near.arc) hessian += (u.x() * p.x() + u.y() * p.y()) / (r * r) * (t * t.transpose());
  return hit_on({z, u, std::max(0.0, u.dot(e.rise)), hessian, 0.0}, e.rows, line);
}

}  // namespace tubecut::joint
