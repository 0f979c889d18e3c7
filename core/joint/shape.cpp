#include "core/joint/shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/elementary.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSeam = 1e-12;       // relative; two pieces that meet tangentially both hold there
constexpr double kWidestCone = 80.0;  // deg

tl::unexpected<Error> parallel(std::string_view member, double sine) {
  return fail({.code = ErrorCode::parallel_axes,
               .member = std::string(member),
               .got = elementary::asin(std::clamp(sine, -1.0, 1.0)) * kDegPerRad,
               .limit = elementary::asin(kParallel) * kDegPerRad,
               .unit = "deg"});
}

tl::unexpected<Error> out_of_range(std::string_view member, std::string_view field, double got,
                                   double limit, std::string unit) {
  return fail({.code = ErrorCode::out_of_range,
               .member = std::string(member) + "/" + std::string(field),
               .got = got,
               .limit = limit,
               .unit = std::move(unit)});
}

/// The frame with its origin where the axis is nearest to the target's: far points lose digits.
struct Made {
  ShapeFrame frame;
  double moved = 0.0;  // along the axis
};

Result<Made> frame_of(const Vector3d& point, const Vector3d& direction, const Vector3d& up,
                      std::string_view member) {
  const double length = direction.norm();
  if (!(length > 0.0))
    return fail({.code = ErrorCode::zero_length, .member = std::string(member) + "/axis"});
  const Vector3d d = direction / length;
  const Vector3d across = up - up.dot(d) * d;
  const double size = across.norm();
  if (!(up.norm() > 0.0))
    return fail({.code = ErrorCode::zero_length, .member = std::string(member) + "/up"});
  if (!(size >= kParallel * up.norm()))
    return fail(
        {.code = ErrorCode::bad_reference_direction, .member = std::string(member) + "/up"});
  const double flat = d.x() * d.x() + d.y() * d.y();
  if (!(flat >= kParallel * kParallel)) return parallel(member, std::sqrt(flat));
  Made out;
  out.moved = -(point.x() * d.x() + point.y() * d.y()) / flat;
  out.frame.point = point + out.moved * d;
  out.frame.rows.row(1) = across / size;
  out.frame.rows.row(0) = (across / size).cross(d);
  out.frame.rows.row(2) = d;
  out.frame.rise = out.frame.rows.col(2);
  return out;
}

Matrix3d round_hessian(const Vector2d& u, double radius, double scale) {
  Matrix3d h = Matrix3d::Zero();
  h.topLeftCorner<2, 2>() = scale / radius * (Eigen::Matrix2d::Identity() - u * u.transpose());
  return h;
}

// ---- cone: A z^2 + 2 B z + C = 0 along the generator

struct Quadratic {
  double a, b;
  double beside;  // of the axis, scaled so that the silhouettes are at +-rest
  double rest;    // the radius where the generator passes the axis
  double s;       // sqrt(B^2 - A C), 0 beyond the silhouette
  double z() const { return (s - b) / a; }
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
  // B^2 - A C = wp^2 (rest^2 - beside^2): no squares that cancel.
  q.s = wp * std::sqrt(std::max(0.0, (q.rest - q.beside) * (q.rest + q.beside)));
  return q;
}

double radius_at(const PreparedCone& cone, const Vector3d& o, double z) {
  return cone.radius + cone.slope * (o.z() + z * cone.frame.rise.z());
}

// ---- box: the section of prism and generator in the plane across the axis

struct Section {
  Vector2d o, w, inner;
  double c;
  Vector2d normal;  // across the line, unit
  double offset, support;
};

Section section(const PreparedBox& box, const Generator& line) {
  Section s;
  const Vector3d foot = box.frame.foot(line);
  s.o = foot.head<2>();
  s.w = box.frame.rise.head<2>();
  s.c = box.corner;
  s.inner = {box.half_width - s.c, box.half_height - s.c};
  s.normal = Vector2d(-s.w.y(), s.w.x()) / elementary::hypot(s.w.x(), s.w.y());
  s.offset = s.normal.dot(s.o);
  s.support = std::abs(s.normal.x()) * s.inner.x() + std::abs(s.normal.y()) * s.inner.y() + s.c;
  return s;
}

struct Leaving {
  double z;
  Vector2d normal;
  double steep;  // normal . w
  bool round;
};

/// The corner's circle, its upper point; S clamped.
Leaving on_corner(const Section& s, const Vector2d& center) {
  const double ww = s.w.squaredNorm();
  const Vector2d from = s.o - center;
  const double beside = s.normal.dot(from);
  const double half = std::sqrt(std::max(0.0, (s.c - beside) * (s.c + beside)));
  const double length = std::sqrt(ww);
  Leaving out;
  out.z = (half - from.dot(s.w) / length) / length;
  const Vector2d n = (beside * s.normal + half * s.w / length) / s.c;
  out.normal = n / std::max(1.0, n.norm());
  out.steep = half * length / s.c;
  out.round = true;
  return out;
}

/// The corner the line touches, or passes nearest to, from outside.
Vector2d touched_corner(const Section& s) {
  const double side = s.offset < 0.0 ? -1.0 : 1.0;
  const auto pick = [&](double n, double w, double half) {
    return (std::abs(n) < kSeam ? w : side * n) < 0.0 ? -half : half;
  };
  return {pick(s.normal.x(), s.w.x(), s.inner.x()), pick(s.normal.y(), s.w.y(), s.inner.y())};
}

Leaving leaving(const Section& s) {
  if (std::abs(s.offset) >= s.support) return on_corner(s, touched_corner(s));
  const double slack = kSeam * (s.inner.norm() + s.c);
  Leaving best{0.0, Vector2d::Zero(), 0.0, false};
  bool found = false;
  const auto take = [&](const Leaving& one) {
    if (!found || one.z > best.z) best = one;
    found = true;
  };
  for (const Eigen::Index i : {0, 1}) {
    const Eigen::Index j = 1 - i;
    if (s.w[i] == 0.0) continue;
    const double side = s.w[i] > 0.0 ? 1.0 : -1.0;
    const double z = (side * (s.inner[i] + s.c) - s.o[i]) / s.w[i];
    if (std::abs(s.o[j] + z * s.w[j]) > s.inner[j] + slack) continue;
    Leaving flat{z, Vector2d::Zero(), std::abs(s.w[i]), false};
    flat.normal[i] = side;
    take(flat);
  }
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const Vector2d center(x * s.inner.x(), y * s.inner.y());
      if (std::abs(s.normal.dot(s.o - center)) > s.c) continue;
      const auto one = on_corner(s, center);
      if (x * one.normal.x() < -kSeam || y * one.normal.y() < -kSeam) continue;
      take(one);
    }
  return found ? best : on_corner(s, touched_corner(s));
}

}  // namespace

Hit hit_on(const SurfaceAt& surface, const Matrix3d& rows, const Generator& line) {
  const Vector3d radial = rows * Vector3d(line.cos_phi, line.sin_phi, 0.0);
  const Vector3d round = rows * Vector3d(-line.sin_phi, line.cos_phi, 0.0);
  Hit out;
  out.z = surface.z;
  out.normal = {surface.gradient.dot(radial), surface.gradient.dot(round), surface.steep};
  out.z_dphi = -line.radius * out.normal.y() / surface.steep;
  const Vector3d tangent = line.radius * round + out.z_dphi * rows.col(2);
  out.z_dphi2 =
      (line.radius * out.normal.x() - tangent.dot(surface.hessian * tangent)) / surface.steep;
  out.axial = surface.axial;
  return out;
}

Result<PreparedBox> prepare_shape(const BoxCutter& box, std::string_view member) {
  for (const auto& [field, value] :
       {std::pair{"width", box.width}, std::pair{"height", box.height}})
    if (!(value > 0.0) || !std::isfinite(value))
      return out_of_range(member, field, value, 0.0, "mm");
  const double widest = 0.5 * std::min(box.width, box.height);
  if (!(box.corner > 0.0) || box.corner > widest)
    return out_of_range(member, "corner_radius", box.corner, widest, "mm");
  auto made = frame_of(box.point, box.direction, box.up, member);
  if (!made) return tl::unexpected(made.error());
  return PreparedBox{made->frame, 0.5 * box.width, 0.5 * box.height, box.corner};
}

Result<PreparedCone> prepare_shape(const ConeCutter& cone, std::string_view member) {
  if (!(cone.radius > 0.0) || !std::isfinite(cone.radius))
    return out_of_range(member, "radius", cone.radius, 0.0, "mm");
  if (!(std::abs(cone.half_angle.deg()) <= kWidestCone))
    return out_of_range(member, "half_angle", cone.half_angle.deg(), kWidestCone, "deg");
  const Vector3d any = cone.direction.unitOrthogonal();
  auto made = frame_of(cone.point, cone.direction, any, member);
  if (!made) return tl::unexpected(made.error());
  const double slope = elementary::tan(cone.half_angle.rad());
  const PreparedCone out{made->frame, cone.radius + slope * made->moved, slope};
  if (!(shape_sine(out) >= kParallel)) return parallel(member, shape_sine(out));
  return out;
}

double shape_sine(const PreparedBox& box) {
  return elementary::hypot(box.frame.rise.x(), box.frame.rise.y());
}

double shape_sine(const PreparedCone& cone) {
  const auto& w = cone.frame.rise;
  return (elementary::hypot(w.x(), w.y()) - std::abs(cone.slope * w.z())) /
         elementary::hypot(1.0, cone.slope);
}

std::optional<double> shape_top(const PreparedBox& box, const Generator& line) {
  const auto s = section(box, line);
  if (std::abs(s.offset) > s.support + kTouch * (s.support + line.radius)) return std::nullopt;
  return leaving(s).z;
}

Hit shape_hit(const PreparedBox& box, const Generator& line) {
  const auto out = leaving(section(box, line));
  const Vector3d gradient(out.normal.x(), out.normal.y(), 0.0);
  const Matrix3d hessian =
      out.round ? round_hessian(out.normal, box.corner, 1.0) : Matrix3d(Matrix3d::Zero());
  const double axial = box.frame.foot(line).z() + out.z * box.frame.rise.z();
  return hit_on({out.z, gradient, out.steep, hessian, axial}, box.frame.rows, line);
}

double shape_touch(const PreparedBox& box, const Generator& line) {
  const auto s = section(box, line);
  return -(s.o - touched_corner(s)).dot(s.w) / s.w.squaredNorm();
}

Sides shape_sides(const PreparedBox& box, const Generator& line) {
  const auto s = section(box, line);
  return {-s.offset - s.support, s.offset - s.support};
}

std::optional<double> shape_top(const PreparedCone& cone, const Generator& line) {
  const Vector3d o = cone.frame.foot(line);
  const auto q = quadratic(cone, o);
  if (std::abs(q.beside) - q.rest > kTouch * (std::abs(q.rest) + line.radius)) return std::nullopt;
  return q.z();
}

Hit shape_hit(const PreparedCone& cone, const Generator& line) {
  const Vector3d o = cone.frame.foot(line);
  const auto q = quadratic(cone, o);
  const double z = q.z();
  const double radius = radius_at(cone, o, z);
  const double scale = 1.0 / elementary::hypot(1.0, cone.slope);
  const Vector2d across = (o + z * cone.frame.rise).head<2>();
  const Vector2d u = across / elementary::hypot(across.x(), across.y());
  const Vector3d gradient = scale * Vector3d(u.x(), u.y(), -cone.slope);
  const double axial = o.z() + z * cone.frame.rise.z();
  return hit_on({z, gradient, scale * q.s / radius, round_hessian(u, radius, scale), axial},
                cone.frame.rows, line);
}

double shape_touch(const PreparedCone& cone, const Generator& line) {
  const auto q = quadratic(cone, cone.frame.foot(line));
  return -q.b / q.a;
}

// The discriminant as a product of two factors linear in the generator's place; on the other nappe
// both are negative.
Sides shape_sides(const PreparedCone& cone, const Generator& line) {
  const auto q = quadratic(cone, cone.frame.foot(line));
  return {-q.beside - q.rest, q.beside - q.rest};
}

}  // namespace tubecut::joint
