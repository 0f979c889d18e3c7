#include "core/joint/cutter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/elementary.hpp"
#include "core/joint/sheets.hpp"

namespace tubecut::joint {
namespace {

constexpr double kCorner = 1e-9;  // relative width within which a tangency counts as a corner

/// The generator in the cutter's frame: u, v of the spec and the cutter's cross-section (X, S).
struct Local {
  double cos_delta, sin_delta, u, v, x;
  double below, above;  // r - X, r + X
  double s = 0.0;       // S, half the chord; 0 beyond the silhouette
};

// r -+ X, where the target's own side is nearest, by sin^2 instead of 1 - cos: next to a tangency
// r - rho cos(delta) would keep no digit.
Local local(const PreparedTube& t, const Generator& g) {
  Local p{};
  p.cos_delta = g.cos_phi * t.cos_clocking + g.sin_phi * t.sin_clocking;
  p.sin_delta = g.sin_phi * t.cos_clocking - g.cos_phi * t.sin_clocking;
  p.u = g.radius * p.cos_delta;
  p.v = g.radius * p.sin_delta;
  p.x = p.u + t.offset;
  const double sagitta = p.v * p.sin_delta / (1.0 + std::abs(p.cos_delta));
  const bool front = p.cos_delta >= 0.0;
  p.below = front ? (t.radius - t.offset - g.radius) + sagitta : t.radius - p.x;
  p.above = front ? t.radius + p.x : (t.radius + t.offset - g.radius) + sagitta;
  p.s = std::sqrt(std::max(p.below, 0.0) * std::max(p.above, 0.0));
  return p;
}

bool touches(const PreparedTube& t, const Generator& g, const Local& p) {
  return std::min(p.below, p.above) >= -kTouch * (t.radius + g.radius);
}

double sheet(const PreparedTube& t, const Local& p) {
  return t.height + (p.s - p.v * t.cos_inclination) / t.sin_inclination;
}

double level(const PreparedPlane& plane, const Generator& g) {
  return plane.height + g.radius * (plane.slope_x * g.cos_phi + plane.slope_y * g.sin_phi);
}

/// The normal for the direction (cos theta, sin theta) in the cutter's cross-section.
Eigen::Vector3d normal(const PreparedTube& t, const Local& p, double cos_theta, double sin_theta) {
  return {cos_theta * p.cos_delta + t.cos_inclination * sin_theta * p.sin_delta,
          -cos_theta * p.sin_delta + t.cos_inclination * sin_theta * p.cos_delta,
          t.sin_inclination * sin_theta};
}

double clamped_cosine(const PreparedTube& t, const Local& p) {
  return std::clamp(p.x / t.radius, -1.0, 1.0);
}

Hit tube_hit(const PreparedTube& t, const Local& p) {
  const double ds = p.x * p.v / p.s;
  const double dds = (p.x * p.u - p.v * p.v - ds * ds) / p.s;
  return {.z = sheet(t, p),
          .normal = normal(t, p, clamped_cosine(t, p), p.s / t.radius),
          .z_dphi = (ds - p.u * t.cos_inclination) / t.sin_inclination,
          .z_dphi2 = (dds + p.v * t.cos_inclination) / t.sin_inclination,
          .axial = (p.s * t.cos_inclination - p.v) / t.sin_inclination};
}

Hit plane_hit(const PreparedPlane& plane, const Generator& g) {
  const auto& n = plane.normal;
  return {.z = level(plane, g),
          .normal = {n.x() * g.cos_phi + n.y() * g.sin_phi, n.y() * g.cos_phi - n.x() * g.sin_phi,
                     n.z()},
          .z_dphi = g.radius * (plane.slope_y * g.cos_phi - plane.slope_x * g.sin_phi),
          .z_dphi2 = plane.height - level(plane, g),
          .axial = 0.0};
}

tl::unexpected<Error> parallel(std::string_view member, double sine) {
  return fail({.code = ErrorCode::parallel_axes,
               .member = std::string(member),
               .got = elementary::asin(std::min(sine, 1.0)) * kDegPerRad,
               .limit = elementary::asin(kParallel) * kDegPerRad,
               .unit = "deg",
               .hint = "the angle must be greater than the limit"});
}

Result<Prepared> prepare_tube(const TubeCutter& tube, std::string_view member) {
  if (!(tube.radius > 0.0) || !std::isfinite(tube.radius))
    return fail({.code = ErrorCode::out_of_range,
                 .member = std::string(member) + "/radius",
                 .got = tube.radius,
                 .limit = 0.0,
                 .unit = "mm"});
  const auto a = elementary::sincos(tube.inclination.rad());
  const auto b = elementary::sincos(tube.clocking.rad());
  if (!(a.sin >= kParallel)) return parallel(std::string(member) + "/inclination", std::abs(a.sin));
  return PreparedTube{tube.radius, tube.offset, tube.height, a.cos, a.sin, b.cos, b.sin};
}

Result<Prepared> prepare_plane(const PlaneCutter& plane, std::string_view member) {
  const double length = plane.normal.norm();
  if (!(length > 0.0))
    return fail({.code = ErrorCode::zero_length,
                 .member = std::string(member) + "/normal",
                 .got = 0.0,
                 .limit = 0.0,
                 .hint = "the vector's length must be greater than the limit"});
  Eigen::Vector3d n = plane.normal / length;
  if (n.z() < 0.0) n = -n;
  if (!(n.z() >= kParallel)) return parallel(std::string(member) + "/normal", n.z());
  return PreparedPlane{plane.point.dot(n) / n.z(), -n.x() / n.z(), -n.y() / n.z(), n};
}

/// What each kind of partner does with a generator, one overload set.
template <class Tube, class Plane, class Shape>
auto by_kind(const Prepared& cutter, const Tube& tube, const Plane& plane, const Shape& shape) {
  if (const auto* t = std::get_if<PreparedTube>(&cutter)) return tube(*t);
  if (const auto* p = std::get_if<PreparedPlane>(&cutter)) return plane(*p);
  if (const auto* b = std::get_if<PreparedBox>(&cutter)) return shape(*b);
  if (const auto* c = std::get_if<PreparedCone>(&cutter)) return shape(*c);
  return shape(std::get<PreparedElbow>(cutter));
}

}  // namespace

Generator generator_at(double radius, double phi) {
  const auto at = elementary::sincos(phi);
  return {radius, at.cos, at.sin};
}

Result<Prepared> prepare(const Cutter& cutter, std::string_view member) {
  if (const auto* tube = std::get_if<TubeCutter>(&cutter)) return prepare_tube(*tube, member);
  if (const auto* plane = std::get_if<PlaneCutter>(&cutter)) return prepare_plane(*plane, member);
  if (const auto* box = std::get_if<BoxCutter>(&cutter)) return prepare_shape(*box, member);
  if (const auto* cone = std::get_if<ConeCutter>(&cutter)) return prepare_shape(*cone, member);
  return prepare_elbow(std::get<ElbowCutter>(cutter), member);
}

double sin_inclination(const Prepared& cutter) {
  return by_kind(
      cutter, [](const PreparedTube& t) { return t.sin_inclination; },
      [](const PreparedPlane& p) { return p.normal.z(); },
      [](const auto& shape) { return shape_sine(shape); });
}

std::optional<double> upper_sheet(const Prepared& cutter, const Generator& line) {
  using Top = std::optional<double>;
  return by_kind(
      cutter,
      [&](const PreparedTube& t) {
        const auto p = local(t, line);
        return touches(t, line, p) ? Top(sheet(t, p)) : Top();
      },
      [&](const PreparedPlane& p) { return Top(level(p, line)); },
      [&](const auto& shape) { return shape_top(shape, line); });
}

std::optional<Hit> hit(const Prepared& cutter, const Generator& line) {
  using Found = std::optional<Hit>;
  return by_kind(
      cutter,
      [&](const PreparedTube& t) {
        const auto p = local(t, line);
        return touches(t, line, p) ? Found(tube_hit(t, p)) : Found();
      },
      [&](const PreparedPlane& p) { return Found(plane_hit(p, line)); },
      [&](const auto& shape) {
        return shape_top(shape, line) ? Found(shape_hit(shape, line)) : Found();
      });
}

double continued_sheet(const Prepared& cutter, const Generator& line) {
  return by_kind(
      cutter, [&](const PreparedTube& t) { return sheet(t, local(t, line)); },
      [&](const PreparedPlane& p) { return level(p, line); },
      [&](const auto& shape) {
        const auto top = shape_top(shape, line);
        return top ? *top : shape_touch(shape, line);
      });
}

Hit continued_hit(const Prepared& cutter, const Generator& line) {
  return by_kind(
      cutter, [&](const PreparedTube& t) { return tube_hit(t, local(t, line)); },
      [&](const PreparedPlane& p) { return plane_hit(p, line); },
      [&](const auto& shape) { return shape_hit(shape, line); });
}

double silhouette_height(const Prepared& cutter, const Generator& line) {
  return by_kind(
      cutter,
      [&](const PreparedTube& t) {
        auto p = local(t, line);
        p.s = 0.0;
        return sheet(t, p);
      },
      [&](const PreparedPlane& p) { return level(p, line); },
      [&](const auto& shape) { return shape_touch(shape, line); });
}

// With d the distance in phi from the corner, S = sqrt(r rho) |d| and X = +-(r - rho d^2 / 2); the
// curve is mirrored at delta = 0 and pi, so u and the tangential part take the side's sign.
Hit hit_at_corner(const Prepared& cutter, const Generator& line, Side side) {
  const auto* tube = std::get_if<PreparedTube>(&cutter);
  if (tube == nullptr) return continued_hit(cutter, line);
  constexpr double kBeside = 1e-12;
  const double d = side == Side::before ? -1.0 : 1.0;
  const double front = tube->cos_clocking * line.cos_phi + tube->sin_clocking * line.sin_phi;
  const double u = front >= 0.0 ? line.radius : -line.radius;
  const double ratio = std::sqrt(line.radius / tube->radius);  // dS/dphi / r
  const double cos_a = tube->cos_inclination * (front >= 0.0 ? 1.0 : -1.0);
  const double sin_a = tube->sin_inclination;
  const double ds = d * ratio * tube->radius;
  return {.z = tube->height,
          .normal = {1.0, kBeside * (-d + cos_a * ratio), kBeside * sin_a * ratio},
          .z_dphi = (ds - u * tube->cos_inclination) / sin_a,
          .z_dphi2 = 0.0,
          .axial = 0.0};
}

Eigen::Vector3d published_normal(const Prepared& cutter, const Generator& line) {
  const auto* tube = std::get_if<PreparedTube>(&cutter);
  if (tube == nullptr) return continued_hit(cutter, line).normal;
  const auto p = local(*tube, line);
  const double cos_theta = clamped_cosine(*tube, p);
  auto n = normal(*tube, p, cos_theta, p.s / tube->radius);
  n.y() = cos_theta * p.sin_delta + tube->cos_inclination * p.s / tube->radius * p.cos_delta;
  return n;
}

bool is_tangent(const PreparedTube& tube, double rho) {
  return std::abs(tube.radius - rho - std::abs(tube.offset)) <= kCorner * tube.radius;
}

bool misses(const Prepared& cutter, double rho) {
  return by_kind(
      cutter, [&](const PreparedTube& t) { return std::abs(t.offset) >= t.radius + rho; },
      [](const PreparedPlane&) { return false; },
      [&](const auto&) {
        // Between two neighbouring silhouettes all generators hit or all miss.
        auto phases = silhouettes(cutter, rho);
        if (phases.empty()) return !upper_sheet(cutter, generator_at(rho, 0.5)).has_value();
        std::ranges::sort(phases);
        phases.push_back(phases.front() + kTwoPi);
        for (std::size_t k = 0; k + 1 < phases.size(); ++k)
          if (upper_sheet(cutter, generator_at(rho, 0.5 * (phases[k] + phases[k + 1]))))
            return false;
        return true;
      });
}

std::optional<double> upper_sheet(const Cutter& cutter, double rho, Angle phi) {
  const auto prepared = prepare(cutter, "");
  if (!prepared) return std::nullopt;
  return upper_sheet(*prepared, generator_at(rho, phi.rad()));
}

std::optional<Hit> hit(const Cutter& cutter, double rho, Angle phi) {
  const auto prepared = prepare(cutter, "");
  if (!prepared) return std::nullopt;
  return hit(*prepared, generator_at(rho, phi.rad()));
}

}  // namespace tubecut::joint
