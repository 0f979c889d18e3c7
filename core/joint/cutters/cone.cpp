#include "core/joint/cutters/cone.hpp"

#include <Eigen/Geometry>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kWidestCone = 80.0;  // deg

/// A z^2 + 2 B z + C = 0 along the generator.
struct Quadratic {
  double a, b;
  double beside;  // distance to the axis, scaled so that the silhouettes are at +-rest
  double rest;    // the radius where the generator passes the axis
  double s;       // sqrt(B^2 - A C), 0 beyond the silhouette

  [[nodiscard]] double z() const { return (s - b) / a; }
  [[nodiscard]] double touch() const { return -b / a; }
  [[nodiscard]] bool misses(const Generator& line) const {
    return std::abs(beside) - rest > kTouch * (std::abs(rest) + line.radius);
  }
};

Quadratic quadratic(const PreparedCone& cone, const Vector3d& o) {
  const auto& w = cone.frame.rise;
  const double r = cone.radius + cone.slope * o.z();
  const double dr = cone.slope * w.z();
  const double wp = elementary::hypot(w.x(), w.y());
  const double along = (o.x() * w.x() + o.y() * w.y()) / wp;
  Quadratic q{};
  q.a = (wp - dr) * (wp + dr);
  q.b = along * wp - dr * r;
  q.rest = r - dr * along / wp;
  q.beside = (o.x() * w.y() - o.y() * w.x()) / wp * (std::sqrt(q.a) / wp);
  // B^2 - A C = wp^2 (rest^2 - beside^2), a form without squares that cancel.
  q.s = wp * std::sqrt(std::max(0.0, (q.rest - q.beside) * (q.rest + q.beside)));
  return q;
}

Quadratic quadratic(const PreparedCone& cone, const Generator& line) {
  return quadratic(cone, cone.frame.foot(line));
}

}  // namespace

Result<PreparedCone> ConeCutter::prepare() const {
  if (!(radius > 0.0) || !std::isfinite(radius)) return beyond_limit("radius", radius, 0.0, "mm");
  if (!(std::abs(half_angle.deg()) <= kWidestCone))
    return beyond_limit("half_angle", half_angle.deg(), kWidestCone, "deg");
  TRY(const auto made, nearest_frame(point, direction, direction.unitOrthogonal()));
  const double slope = elementary::tan(half_angle.rad());
  const PreparedCone out{{}, made.frame, radius + slope * made.moved, slope};
  if (!(out.sine() >= kParallel))
    return parallel_axes("", out.sine(),
                         "a line of its surface runs along the member; the angle must be greater "
                         "than the limit");
  return out;
}

void ConeCutter::grow(double by) { radius += by / elementary::cos(half_angle.rad()); }

void ConeCutter::turn(const TurnAboutAxis& turn) {
  point = turn.by * point;
  direction = turn.by * direction;
}

// ---- on the target's generators

double PreparedCone::sine() const {
  const auto& w = frame.rise;
  return (elementary::hypot(w.x(), w.y()) - std::abs(slope * w.z())) /
         elementary::hypot(1.0, slope);
}

std::optional<double> PreparedCone::upper_sheet(const Generator& line) const {
  const auto q = quadratic(*this, line);
  if (q.misses(line)) return std::nullopt;
  return q.z();
}

double PreparedCone::continued_sheet(const Generator& line) const {
  const auto q = quadratic(*this, line);
  return q.misses(line) ? q.touch() : q.z();
}

Hit PreparedCone::continued_hit(const Generator& line) const {
  const Vector3d o = frame.foot(line);
  const auto q = quadratic(*this, o);
  const double z = q.z();
  const double round = radius + slope * (o.z() + z * frame.rise.z());
  const double scale = 1.0 / elementary::hypot(1.0, slope);
  const Vector2d across = (o + z * frame.rise).head<2>();
  const Vector2d u = across / elementary::hypot(across.x(), across.y());
  const Vector3d gradient = scale * Vector3d(u.x(), u.y(), -slope);
  const double axial = o.z() + z * frame.rise.z();
  return hit_on({z, gradient, scale * q.s / round, axial}, frame.rows, line);
}

double PreparedCone::silhouette_height(const Generator& line) const {
  return quadratic(*this, line).touch();
}

// The discriminant as a product of two factors linear in the generator's position; on the other
// nappe both are negative.
Sides PreparedCone::sides(const Generator& line) const {
  const auto q = quadratic(*this, line);
  return {-q.beside - q.rest, q.beside - q.rest};
}

std::vector<Sheets> PreparedCone::sheets(double rho) const {
  const auto c = crossing(frame, rho);
  const double dr = slope * frame.rise.z();
  const double a = (c.across - dr) * (c.across + dr);
  const auto round = constant(radius) + slope * c.axial;
  const auto rest = c.across * round - dr * c.along;
  return {{(1.0 / a) * (dr * round - c.across * c.along),
           (1.0 / (a * a)) * (rest * rest - a * (c.beside * c.beside)), size(rho), true}};
}

std::vector<double> PreparedCone::silhouettes(double rho) const {
  std::vector<double> out;
  for (const auto& root : root_phases(sheets(rho).front().square)) out.push_back(root.phi);
  return out;
}

// ---- in space

ConeSolid ConeCutter::solid() const {
  const auto half = elementary::sincos(half_angle.rad());
  return {{}, point, direction.normalized(), radius, half.sin, half.cos};
}

double ConeSolid::distance(const Vector3d& p) const {
  const Vector3d from = p - point;
  return cosine * (from.cross(direction).norm() - radius) - sine * from.dot(direction);
}

Vector3d ConeSolid::normal(const Vector3d& p) const {
  const Vector3d from = p - point;
  const Vector3d radial = (from - from.dot(direction) * direction).normalized();
  return cosine * radial - sine * direction;
}

}  // namespace tubecut::joint
