#include "core/joint/cutters/tube.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/joint/cutters/tube_local.hpp"
#include "core/joint/node/sheets.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kCorner = 1e-9;     // relative width within which a tangency counts as a corner
constexpr double kHair = 1e-9;       // relative; a smaller offset is rounding
constexpr double kOnCutter = 1e-14;  // relative, of lengths: the root is on the tube

using Local = TubeLocal;

Local local(const PreparedTube& t, const Generator& g) {
  return tube_local(t, g.radius, g.cos_phi, g.sin_phi);
}

/// Computes the normal for the direction (cos theta, sin theta) in the cutter's cross-section.
Vector3d normal_at(const PreparedTube& t, const Local& p, double cos_theta, double sin_theta) {
  return {cos_theta * p.cos_delta + t.cos_inclination * sin_theta * p.sin_delta,
          -cos_theta * p.sin_delta + t.cos_inclination * sin_theta * p.cos_delta,
          t.sin_inclination * sin_theta};
}

double clamped_cosine(const PreparedTube& t, const Local& p) {
  return std::clamp(p.x / t.radius, -1.0, 1.0);
}

/// The tube in the half plane of one phi, where it is a convex region (u, v per mm of rho).
struct WallSection {
  const PreparedTube& tube;
  double cos_delta, sin_delta;
  double from, to;  // R: the part of the wall in which the tube is met; empty when from > to

  WallSection(const PreparedTube& t, const Wall& wall, const Generator& g)
      : tube(t),
        cos_delta(g.cos_phi * t.cos_clocking + g.sin_phi * t.sin_clocking),
        sin_delta(g.sin_phi * t.cos_clocking - g.cos_phi * t.sin_clocking),
        from(tube_section(t, wall, cos_delta).from),
        to(tube_section(t, wall, cos_delta).to) {}
};

double sheet_at(const PreparedTube& t, const Generator& g, double rho) {
  return t.continued_sheet({rho, g.cos_phi, g.sin_phi});
}

/// Computes dz/drho = -n_r / n_z where the tube's cross-section has the point (x, y) of its circle.
double slope_at(const WallSection& s, double x, double y) {
  const auto& t = s.tube;
  const double radial = x * s.cos_delta + t.cos_inclination * y * s.sin_delta;
  if (y > 0.0) return -radial / (t.sin_inclination * y);
  return radial > 0.0 ? -kInfinity : kInfinity;
}

/// Computes the largest slope from the root, at (x, y) outside the circle of the tube's
/// cross-section, to the tube within the wall: to the ends of R, or along the tangent from the
/// root.
double slope_from_outside(const WallSection& s, const Wall& wall, const Generator& g, double z_root,
                          double x, double y) {
  const auto& t = s.tube;
  double best = -kInfinity;
  for (const double rho : {s.from, s.to})
    if (rho > wall.inner * (1.0 + kSameHeight))
      best = std::max(best, (sheet_at(t, g, rho) - z_root) / (rho - wall.inner));
  const double square = x * x + y * y;
  const double f = t.radius * t.radius / square;
  const double tangent = t.radius * std::sqrt(square - t.radius * t.radius) / square;
  for (const double side : {tangent, -tangent}) {
    const double tx = f * x - side * y;
    const double ty = f * y + side * x;
    const double rho = (tx - t.offset) / s.cos_delta;
    if (ty >= 0.0 && rho >= s.from && rho <= s.to) best = std::max(best, slope_at(s, tx, ty));
  }
  return best;
}

}  // namespace

Result<PreparedTube> TubeCutter::prepare() const {
  if (!(radius > 0.0) || !std::isfinite(radius)) return beyond_limit("radius", radius, 0.0, "mm");
  const auto a = elementary::sincos(inclination.rad());
  const auto b = elementary::sincos(clocking.rad());
  if (!(a.sin >= kParallel))
    return parallel_axes("inclination", std::abs(a.sin),
                         "the angle must be greater than the limit");
  return PreparedTube{radius, offset, height, a.cos, a.sin, b.cos, b.sin};
}

std::optional<Bearing> TubeCutter::bearing() const {
  const double side = clocking.rad() - 0.5 * kPi;
  const double rise = elementary::cos(inclination.rad());
  Bearing out{math::whole_turn(clocking.rad()), std::nullopt};
  if (std::abs(rise) > kSquare) out.lean = math::whole_turn(rise > 0.0 ? side : side + kPi);
  return out;
}

// ---- on the target's generators

std::optional<double> PreparedTube::upper_sheet(const Generator& line) const {
  const auto p = local(*this, line);
  if (!tube_met(*this, p, line.radius)) return std::nullopt;
  return tube_sheet(*this, p);
}

double PreparedTube::continued_sheet(const Generator& line) const {
  return tube_sheet(*this, local(*this, line));
}

Hit PreparedTube::continued_hit(const Generator& line) const {
  const auto p = local(*this, line);
  return {.z = tube_sheet(*this, p),
          .normal = normal_at(*this, p, clamped_cosine(*this, p), p.s / radius),
          .z_dphi = tube_slope(*this, p),
          .axial = (p.s * cos_inclination - p.v) / sin_inclination};
}

double PreparedTube::silhouette_height(const Generator& line) const {
  auto p = local(*this, line);
  p.s = 0.0;
  return tube_sheet(*this, p);
}

double PreparedTube::silhouette_slope(const Generator& line) const {
  const double u = line.radius * (line.cos_phi * cos_clocking + line.sin_phi * sin_clocking);
  return -u * cos_inclination / sin_inclination;
}

// With d the distance in phi from the corner, S = sqrt(r rho) |d| and X = +-(r - rho d^2 / 2); the
// curve is mirrored at delta = 0 and pi, so u and the tangential part take the side's sign. If the
// tube is wider than the target by more than rounding, the corner is rounded over a very short
// interval of phi: its sides keep their directions, and the normal has the dihedral angle of its
// tip.
Hit PreparedTube::hit_at_corner(const Generator& line, Side side) const {
  constexpr double kBeside = 1e-12;
  const double d = side == Side::before ? -1.0 : 1.0;
  const double front = cos_clocking * line.cos_phi + sin_clocking * line.sin_phi;
  const double u = front >= 0.0 ? line.radius : -line.radius;
  const double ratio = std::sqrt(line.radius / radius);  // dS/dphi / r
  const double cos_a = cos_inclination * (front >= 0.0 ? 1.0 : -1.0);
  const double ds = d * ratio * radius;
  Hit out{.z = height,
          .normal = {1.0, kBeside * (-d + cos_a * ratio), kBeside * sin_inclination * ratio},
          .z_dphi = (ds - u * cos_inclination) / sin_inclination,
          .axial = 0.0};
  const double wider = radius - (front >= 0.0 ? offset : -offset) - line.radius;
  if (!(wider > kTouch * (radius + line.radius))) return out;
  const double slant = std::sqrt(wider * (2.0 * radius - wider)) / radius;
  const double to = slant / elementary::hypot(out.normal.y(), out.normal.z());
  out.normal = {(radius - wider) / radius, to * out.normal.y(), to * out.normal.z()};
  return out;
}

Vector3d PreparedTube::published_normal(const Generator& line) const {
  const auto p = local(*this, line);
  const double cos_theta = clamped_cosine(*this, p);
  auto n = normal_at(*this, p, cos_theta, p.s / radius);
  n.y() = cos_theta * p.sin_delta + cos_inclination * p.s / radius * p.cos_delta;
  return n;
}

Met PreparedTube::met(double rho) const {
  if (std::abs(offset) >= radius + rho) return Met::never;
  return std::abs(offset) + rho <= radius ? Met::always : Met::partly;
}

std::vector<Sheets> PreparedTube::sheets(double rho) const {
  const double tilt = rho * cos_inclination / sin_inclination;
  const auto across = Trig<1>::first_order(offset, rho * cos_clocking, rho * sin_clocking);
  const auto whole = Trig<1>::first_order(radius, 0.0, 0.0);
  const double scale = 1.0 / (sin_inclination * sin_inclination);
  return {{Trig<1>::first_order(height, tilt * sin_clocking, -tilt * cos_clocking),
           scale * ((whole - across) * (whole + across)), size(rho), true}};
}

std::vector<double> PreparedTube::silhouettes(double rho) const {
  std::vector<double> out;
  const double beta = elementary::atan2(sin_clocking, cos_clocking);
  for (const double side : {radius, -radius}) {
    const double u = side - offset;  // X = +-r
    if (!(std::abs(u) <= rho)) continue;
    const double delta = elementary::atan2(std::sqrt((rho - u) * (rho + u)), u);
    out.push_back(beta + delta);
    out.push_back(beta - delta);
  }
  return out;
}

// Finds where the target's surface is tangent to the tube from inside; if the radii are equal, both
// sides are.
std::vector<double> PreparedTube::kinks(double rho) const {
  std::vector<double> out;
  if (!(std::abs(radius - rho - std::abs(offset)) <= kCorner * radius)) return out;
  const double beta = elementary::atan2(sin_clocking, cos_clocking);
  const double hair = kHair * radius;
  if (offset >= -hair) out.push_back(beta);
  if (offset <= hair) out.push_back(beta + kPi);
  return out;
}

double PreparedTube::steepest(const Wall& wall, const Generator& g, double z_root) const {
  const WallSection s(*this, wall, g);
  if (!(s.from <= s.to) || s.to <= wall.inner * (1.0 + kSameHeight)) return -kInfinity;
  const double x = wall.inner * s.cos_delta + offset;
  const double y = (z_root - height) * sin_inclination + wall.inner * s.sin_delta * cos_inclination;
  const double noise = kOnCutter * (radius + std::abs(z_root) + std::abs(height));
  if (s.from <= wall.inner && x * x + y * y <= radius * (radius + noise) && y >= 0.0)
    return slope_at(s, x, std::sqrt(std::max(0.0, (radius - x) * (radius + x))));
  return slope_from_outside(s, wall, g, z_root, x, y);
}

double PreparedTube::support(const Wall& wall, const Generator& g, double slope) const {
  const WallSection s(*this, wall, g);
  if (!(s.from <= s.to)) return -kInfinity;
  const auto foot = [&](double rho) {
    return sheet_at(*this, g, rho) - (rho - wall.inner) * slope;
  };
  double best = std::max(foot(s.from), foot(s.to));
  // Where the tube's own slope equals the cut's, its normal is (n, cos delta) rotated into X.
  const double n = slope * sin_inclination + s.sin_delta * cos_inclination;
  const double x = -radius * n / elementary::hypot(n, s.cos_delta);
  const double rho = ((s.cos_delta < 0.0 ? -x : x) - offset) / s.cos_delta;
  if (rho > s.from && rho < s.to) best = std::max(best, foot(rho));
  return best;
}

// ---- in space

TubeSolid TubeCutter::solid() const {
  const auto axis = axis_of(*this);
  return {axis.point, axis.direction, radius};
}

double TubeSolid::distance(const Vector3d& p) const {
  return (p - point).cross(direction).norm() - radius;
}

Vector3d TubeSolid::normal(const Vector3d& p) const {
  const Vector3d from = p - point;
  return (from - from.dot(direction) * direction).normalized();
}

std::optional<double> TubeSolid::top(double x, double y) const {
  // |(from + z e_z) - ((from + z e_z).d) d|^2 = r^2, a quadratic in z.
  const Vector3d from = Vector3d(x, y, 0.0) - point;
  const Vector3d across = from - from.dot(direction) * direction;
  const Vector3d up = Vector3d::UnitZ() - direction.z() * direction;
  const double a = up.squaredNorm();
  const double half_b = across.dot(up);
  const double gap = clearance(x, y);
  if (gap > 1e-12 * (radius + from.norm())) return std::nullopt;
  // The discriminant is a (r - m)(r + m), with m the smallest distance of line and axis: no
  // cancellation.
  const double inside = std::max(0.0, -gap * (gap + 2.0 * radius));
  return (-half_b + std::sqrt(a * inside)) / a;
}

double TubeSolid::clearance(double x, double y) const {
  const Vector3d from = Vector3d(x, y, 0.0) - point;
  const Vector3d common = direction.cross(Vector3d::UnitZ()).normalized();
  return std::abs(from.dot(common)) - radius;
}

// Along a line the squared distance to the axis is a parabola, which three of its points determine.
double TubeSolid::least_distance(const Vector3d& a, const Vector3d& b) const {
  const double ends[] = {distance(a), distance(0.5 * (a + b)), distance(b)};
  const double least = std::min({ends[0], ends[1], ends[2]});
  const auto square = [&](double d) { return (d + radius) * (d + radius); };
  const double low = square(ends[0]), mid = square(ends[1]), high = square(ends[2]);
  const double bend = 2.0 * (low - 2.0 * mid + high);
  if (!(radius > 0.0 && bend > 0.0)) return least;
  const double share = std::clamp((3.0 * low - 4.0 * mid + high) / (2.0 * bend), 0.0, 1.0);
  return std::min(least, distance(a + share * (b - a)));
}

double TubeSolid::nearest_share(const Vector3d& a, const Vector3d& b) const {
  const Vector3d way = b - a;
  const Vector3d across = way - way.dot(direction) * direction;
  const double square = across.squaredNorm();
  return square > 0.0 ? std::clamp((point - a).dot(across) / square, 0.0, 1.0) : 0.0;
}

double TubeSolid::most_bent(double from) const {
  const double from_axis = radius + from;
  return from_axis > 0.0 ? 1.0 / from_axis : kInfinity;
}

// ---- distances from its axis

Result<Placement> place(const AxisLine& axis, double radius) {
  const double length = axis.direction.norm();
  if (!(length > 0.0)) return zero_length("direction");
  const Vector3d d = axis.direction / length;
  const double sin_a = elementary::hypot(d.x(), d.y());
  const double inclination = elementary::atan2(sin_a, d.z());
  if (!(sin_a >= kParallel))
    return fail({.code = ErrorCode::parallel_axes,
                 .member = "direction",
                 .got = std::min(inclination, kPi - inclination) * kDegPerRad,
                 .limit = kParallel * kDegPerRad,
                 .unit = "deg",
                 .hint = "the angle must be greater than the limit"});
  const double cos_b = -d.y() / sin_a;
  const double sin_b = d.x() / sin_a;
  const double clocking = elementary::atan2(sin_b, cos_b);
  const auto& q = axis.point;
  const double to_foot = (q.y() * cos_b - q.x() * sin_b) / sin_a;
  return Placement{.tube = {.radius = radius,
                            .inclination = Angle::rad(inclination),
                            .clocking = Angle::rad(clocking < 0.0 ? clocking + kTwoPi : clocking),
                            .offset = -(q.x() * cos_b + q.y() * sin_b),
                            .height = q.z() + to_foot * d.z()},
                   .point_axial = -to_foot};
}

AxisLine axis_of(const TubeCutter& tube) {
  const auto a = elementary::sincos(tube.inclination.rad());
  const auto b = elementary::sincos(tube.clocking.rad());
  return {{-tube.offset * b.cos, -tube.offset * b.sin, tube.height},
          {a.sin * b.sin, -a.sin * b.cos, a.cos}};
}

Result<TubeCutter> AxisTube::tube() const {
  TRY(const auto placed, under("axis", place(axis, radius)));
  return placed.tube;
}

void AxisTube::turn(const TurnAboutAxis& turn) {
  axis.point = turn.by * axis.point;
  axis.direction = turn.by * axis.direction;
}

}  // namespace tubecut::joint
