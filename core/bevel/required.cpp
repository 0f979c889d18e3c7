#include "core/bevel/required.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

using joint::Generator;
using joint::Prepared;
using joint::PreparedPlane;
using joint::PreparedTube;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTouch = 2.5e-13;     // relative, as on the contour
constexpr double kOnCutter = 1e-14;    // relative, of lengths: the root is on the tube
constexpr double kSameHeight = 1e-12;  // relative, of two heights of one place

/// One tube in the half plane of one phi, where it is a convex region (u, v per mm of rho).
struct Section {
  const PreparedTube& tube;
  double cos_delta, sin_delta;
  double from, to;  // R: the part of the wall where the tube is met; empty if from > to
};

Section section(const PreparedTube& t, const Wall& wall, const Generator& g) {
  Section s{t, g.cos_phi * t.cos_clocking + g.sin_phi * t.sin_clocking,
            g.sin_phi * t.cos_clocking - g.cos_phi * t.sin_clocking, wall.inner, wall.outer};
  const double reach = t.radius + kTouch * (t.radius + wall.outer);
  const double c = std::abs(s.cos_delta);
  const double shift = s.cos_delta < 0.0 ? -t.offset : t.offset;  // |rho cos + s| = |rho c + shift|
  if (c * wall.inner + shift < -reach) s.from = (-reach - shift) / c;
  if (c * wall.outer + shift > reach) s.to = (reach - shift) / c;
  return s;
}

double sheet(const PreparedTube& t, const Generator& g, double rho) {
  return joint::continued_sheet(t, Generator{rho, g.cos_phi, g.sin_phi});
}

/// dz/drho = -n_r / n_z where the tube's cross-section has the point (x, y) of its circle.
double slope_at(const Section& s, double x, double y) {
  const auto& t = s.tube;
  const double radial = x * s.cos_delta + t.cos_inclination * y * s.sin_delta;
  if (y > 0.0) return -radial / (t.sin_inclination * y);
  return radial > 0.0 ? -kInfinity : kInfinity;
}

/// Largest slope from the root, seen in the tube's cross-section at (x, y) outside its circle, to
/// the tube within the wall: to the ends of R, or along the tangent from the root.
double slope_from_outside(const Section& s, const Wall& wall, const Generator& g, double z_root,
                          double x, double y) {
  const auto& t = s.tube;
  double best = -kInfinity;
  for (const double rho : {s.from, s.to})
    if (rho > wall.inner * (1.0 + kSameHeight))
      best = std::max(best, (sheet(t, g, rho) - z_root) / (rho - wall.inner));
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

double tube_slope(const PreparedTube& t, const Wall& wall, const Generator& g, double z_root) {
  const auto s = section(t, wall, g);
  if (!(s.from <= s.to) || s.to <= wall.inner * (1.0 + kSameHeight)) return -kInfinity;
  const double x = wall.inner * s.cos_delta + t.offset;
  const double y =
      (z_root - t.height) * t.sin_inclination + wall.inner * s.sin_delta * t.cos_inclination;
  const double noise = kOnCutter * (t.radius + std::abs(z_root) + std::abs(t.height));
  if (s.from <= wall.inner && x * x + y * y <= t.radius * (t.radius + noise) && y >= 0.0)
    return slope_at(s, x, std::sqrt(std::max(0.0, (t.radius - x) * (t.radius + x))));
  return slope_from_outside(s, wall, g, z_root, x, y);
}

double plane_slope(const PreparedPlane& p, const Wall& wall, const Generator& g, double z_root) {
  const double slope = p.slope_x * g.cos_phi + p.slope_y * g.sin_phi;
  const double gap = z_root - (p.height + wall.inner * slope);
  return slope - std::max(0.0, gap) / (wall.outer - wall.inner);
}

double tube_lift(const PreparedTube& t, const Wall& wall, const Generator& g, double slope) {
  const auto s = section(t, wall, g);
  if (!(s.from <= s.to)) return -kInfinity;
  const auto support = [&](double rho) { return sheet(t, g, rho) - (rho - wall.inner) * slope; };
  double best = std::max(support(s.from), support(s.to));
  // Where the tube's own slope equals the cut's: its normal is (n, cos delta) turned into X.
  const double n = slope * t.sin_inclination + s.sin_delta * t.cos_inclination;
  const double x = -t.radius * n / elementary::hypot(n, s.cos_delta);
  const double rho = ((s.cos_delta < 0.0 ? -x : x) - t.offset) / s.cos_delta;
  if (rho > s.from && rho < s.to) best = std::max(best, support(rho));
  return best;
}

}  // namespace

double required_bevel(std::span<const Prepared> cutters, const Wall& wall,
                      const Generator& inner_line, double z_root) {
  double slope = -kInfinity;
  for (const auto& cutter : cutters) {
    const auto* tube = std::get_if<PreparedTube>(&cutter);
    slope = std::max(slope, tube != nullptr ? tube_slope(*tube, wall, inner_line, z_root)
                                            : plane_slope(std::get<PreparedPlane>(cutter), wall,
                                                          inner_line, z_root));
  }
  return elementary::atan(slope);
}

double lift(std::span<const Prepared> cutters, const Wall& wall, const Generator& inner_line,
            double slope) {
  double z = -kInfinity;
  for (const auto& cutter : cutters) {
    const auto* tube = std::get_if<PreparedTube>(&cutter);
    if (tube != nullptr) {
      z = std::max(z, tube_lift(*tube, wall, inner_line, slope));
      continue;
    }
    const auto& p = std::get<PreparedPlane>(cutter);
    const double own = p.slope_x * inner_line.cos_phi + p.slope_y * inner_line.sin_phi;
    z = std::max(
        z, p.height + wall.inner * own + std::max(0.0, (wall.outer - wall.inner) * (own - slope)));
  }
  return z;
}

}  // namespace tubecut::bevel
