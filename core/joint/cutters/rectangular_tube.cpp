#include "core/joint/cutters/rectangular_tube.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSeam = 1e-12;    // relative; where two surfaces meet tangentially, both are valid
constexpr double kUpright = 1e-9;  // a steeper face is met only at its corners
constexpr double kAlongTube = 3e-8;  // rad: sides nearer to the direction of the tube are along it
constexpr double kLeastCorner = 1e-3;  // mm, of a surface moved inwards by more than its corner

/// The section of prism and generator in the plane across the axis.
struct CrossSection {
  Vector2d o, w, inner;
  double c;
  Vector2d normal;  // across the line, unit
  double offset, support;
};

CrossSection section(const PreparedRectangularTube& box, const Generator& line) {
  CrossSection s;
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
};

/// The corner's circle, its upper point; S is clamped.
Leaving on_corner(const CrossSection& s, const Vector2d& center) {
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
  return out;
}

/// Returns the corner that the line touches, or that it passes nearest from outside.
Vector2d touched_corner(const CrossSection& s) {
  const double side = s.offset < 0.0 ? -1.0 : 1.0;
  const auto pick = [&](double n, double w, double half) {
    return (std::abs(n) < kSeam ? w : side * n) < 0.0 ? -half : half;
  };
  return {pick(s.normal.x(), s.w.x(), s.inner.x()), pick(s.normal.y(), s.w.y(), s.inner.y())};
}

Leaving leaving(const CrossSection& s) {
  if (std::abs(s.offset) >= s.support) return on_corner(s, touched_corner(s));
  const double slack = kSeam * (s.inner.norm() + s.c);
  Leaving best{0.0, Vector2d::Zero(), 0.0};
  bool found = false;
  const auto take = [&](const Leaving& one) {
    if (!found || one.z > best.z) best = one;
    found = true;
  };
  for (const Eigen::Index i : {0, 1}) {
    const Eigen::Index j = 1 - i;
    if (std::abs(s.w[i]) < kUpright) continue;
    const double side = s.w[i] > 0.0 ? 1.0 : -1.0;
    const double z = (side * (s.inner[i] + s.c) - s.o[i]) / s.w[i];
    if (std::abs(s.o[j] + z * s.w[j]) > s.inner[j] + slack) continue;
    Leaving flat{z, Vector2d::Zero(), std::abs(s.w[i])};
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

double touch(const CrossSection& s) {
  return -(s.o - touched_corner(s)).dot(s.w) / s.w.squaredNorm();
}

bool misses(const CrossSection& s, const Generator& line) {
  return std::abs(s.offset) > s.support + kTouch * (s.support + line.radius);
}

RectangularTubeCutter straightened(RectangularTubeCutter box) {
  box.straighten(kAlongTube);
  return box;
}

}  // namespace

Result<PreparedRectangularTube> RectangularTubeCutter::prepare() const {
  for (const auto& [field, value] : {std::pair{"width", width}, std::pair{"height", height}})
    if (!(value > 0.0) || !std::isfinite(value)) return beyond_limit(field, value, 0.0, "mm");
  const double widest = 0.5 * std::min(width, height);
  if (!(corner > 0.0) || corner > widest)
    return beyond_limit("corner_radius", corner, widest, "mm");
  TRY(nearest_frame(point, direction, up));  // its errors
  const auto box = straightened(*this);
  TRY(const auto made, nearest_frame(box.point, box.direction, box.up));
  return PreparedRectangularTube{{}, made.frame, 0.5 * width, 0.5 * height, corner};
}

void RectangularTubeCutter::grow(double by) {
  width += 2.0 * by;
  height += 2.0 * by;
  corner = std::max(corner + by, std::min(corner, kLeastCorner));
}

void RectangularTubeCutter::straighten(double within) {
  Vector3d along = direction.normalized();
  Vector3d normal = up.cross(along).normalized();
  for (int side = 0; side < 2; ++side) {
    if (normal.z() != 0.0 && std::abs(normal.z()) < within) {
      normal.z() = 0.0;
      normal.normalize();
      along = (along - normal.dot(along) * normal).normalized();
      direction = along;
      up = side == 0 ? along.cross(normal) : normal;
    }
    normal = along.cross(normal);  // from across to up
  }
}

void RectangularTubeCutter::turn(const TurnAboutAxis& turn) {
  point = turn.by * point;
  direction = turn.by * direction;
  up = turn.by * up;
}

// ---- on the target's generators

double PreparedRectangularTube::sine() const {
  return elementary::hypot(frame.rise.x(), frame.rise.y());
}

std::optional<double> PreparedRectangularTube::upper_sheet(const Generator& line) const {
  const auto s = section(*this, line);
  if (misses(s, line)) return std::nullopt;
  return leaving(s).z;
}

double PreparedRectangularTube::continued_sheet(const Generator& line) const {
  const auto s = section(*this, line);
  return misses(s, line) ? touch(s) : leaving(s).z;
}

Hit PreparedRectangularTube::continued_hit(const Generator& line) const {
  const auto out = leaving(section(*this, line));
  const Vector3d gradient(out.normal.x(), out.normal.y(), 0.0);
  const double axial = frame.foot(line).z() + out.z * frame.rise.z();
  return hit_on({out.z, gradient, out.steep, axial}, frame.rows, line);
}

double PreparedRectangularTube::silhouette_height(const Generator& line) const {
  return touch(section(*this, line));
}

Sides PreparedRectangularTube::sides(const Generator& line) const {
  const auto s = section(*this, line);
  return {-s.offset - s.support, s.offset - s.support};
}

double PreparedRectangularTube::size(double rho) const {
  return std::ranges::max(sheets(rho), {}, &Sheets::size).size;
}

std::vector<Sheets> PreparedRectangularTube::sheets(double rho) const {
  std::vector<Sheets> out;
  const auto c = crossing(frame, rho);
  const auto& w = frame.rise;
  const Vector2d half(half_width, half_height);
  const double size = (half.sum() + rho) / c.across;
  for (const Eigen::Index i : {0, 1}) {
    if (std::abs(w[i]) < kUpright) continue;
    const auto foot = frame.component(Vector3d::Unit(i), rho);
    const double side = w[i] > 0.0 ? half[i] : -half[i];
    out.push_back({(1.0 / w[i]) * (constant(side) - foot), {}, size / std::abs(w[i]), false});
  }
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const Vector2d center(x * (half.x() - corner), y * (half.y() - corner));
      const Vector2d u(w.x() / c.across, w.y() / c.across);
      const auto along = c.along - constant(center.dot(u));
      const auto beside = c.beside - constant(center.x() * u.y() - center.y() * u.x());
      const auto radius = constant(corner);
      out.push_back({(-1.0 / c.across) * along,
                     (1.0 / (c.across * c.across)) * ((radius - beside) * (radius + beside)), size,
                     true});
    }
  return out;
}

// The generator touches a corner: a straight line at distance `corner` from its centre.
std::vector<double> PreparedRectangularTube::silhouettes(double rho) const {
  std::vector<double> out;
  const auto& w = frame.rise;
  const auto c = crossing(frame, rho);
  const double support =
      (std::abs(w.y()) * (half_width - corner) + std::abs(w.x()) * (half_height - corner)) /
          c.across +
      corner;
  for (const double side : {support, -support})
    for (const auto& root : root_phases(c.beside - constant(side))) out.push_back(root.phi);
  return out;
}

// ---- in space

RectangularTubeSolid RectangularTubeCutter::solid() const {
  const auto box = straightened(*this);
  const Vector3d along = box.direction.normalized();
  const Vector3d across = box.up.cross(along).normalized();
  return {{}, point, along, across, along.cross(across), 0.5 * width, 0.5 * height, corner};
}

double RectangularTubeSolid::distance(const Vector3d& p) const {
  const Vector3d from = p - point;
  const double x = std::abs(from.dot(across)) - half_width + corner;
  const double y = std::abs(from.dot(up)) - half_height + corner;
  if (x > 0.0 && y > 0.0) return elementary::hypot(x, y) - corner;
  return std::max(x, y) - corner;
}

Vector3d RectangularTubeSolid::normal(const Vector3d& p) const {
  const Vector3d from = p - point;
  const double x = std::abs(from.dot(across)) - half_width + corner;
  const double y = std::abs(from.dot(up)) - half_height + corner;
  const Vector3d sideways = from.dot(across) < 0.0 ? Vector3d(-across) : across;
  const Vector3d upright = from.dot(up) < 0.0 ? Vector3d(-up) : up;
  if (x > 0.0 && y > 0.0) return (x * sideways + y * upright).normalized();
  return x > y ? sideways : upright;
}

}  // namespace tubecut::joint
