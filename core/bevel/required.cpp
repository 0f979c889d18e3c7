#include "core/bevel/required.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/math/search.hpp"

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

/// A box or cone in the half plane of one phi: convex too, and met where the generator's distance
/// from either side, linear in rho, is not positive.
template <class Shape>
struct ShapeSection {
  const Shape& shape;
  const Generator& line;
  double from, to;  // R; empty if from > to

  ShapeSection(const Shape& s, const Wall& wall, const Generator& g)
      : shape(s), line(g), from(wall.inner), to(wall.outer) {
    const auto in = joint::shape_sides(shape, at(wall.inner));
    const auto out = joint::shape_sides(shape, at(wall.outer));
    for (const auto side : {&joint::Sides::left, &joint::Sides::right})
      clip(in.*side, out.*side, wall);
  }

  [[nodiscard]] Generator at(double rho) const { return {rho, line.cos_phi, line.sin_phi}; }
  [[nodiscard]] double top(double rho) const {
    return joint::continued_sheet(Prepared(shape), at(rho));
  }

 private:
  void clip(double in, double out, const Wall& wall) {
    const double slack = kTouch * wall.outer;
    if (in <= slack && out <= slack) return;
    const double rho = wall.inner + (wall.outer - wall.inner) * (slack - in) / (out - in);
    if (in > slack && out > slack)
      from = kInfinity;
    else if (in > slack)
      from = std::max(from, rho);
    else
      to = std::min(to, rho);
  }
};

/// From a root on the shape its own slope; from one above it the steepest line to it: of a concave
/// curve seen from above, unimodal.
template <class Shape>
double shape_slope(const Shape& shape, const Wall& wall, const Generator& g, double z_root) {
  const ShapeSection s(shape, wall, g);
  if (!(s.from <= s.to) || s.to <= wall.inner * (1.0 + kSameHeight)) return -kInfinity;
  const double noise = kSameHeight * (wall.outer + std::abs(z_root));
  if (s.from <= wall.inner && s.top(wall.inner) >= z_root - noise) {
    const auto n = joint::shape_hit(shape, g).normal;
    if (n.z() > 0.0) return -n.x() / n.z();
    return n.x() > 0.0 ? -kInfinity : kInfinity;
  }
  const auto slope = [&](double rho) { return (s.top(rho) - z_root) / (rho - wall.inner); };
  const double from = std::max(s.from, wall.inner + kSameHeight * wall.outer);
  return std::max({slope(from), slope(s.to), math::golden_maximum(slope, from, s.to).value});
}

template <class Shape>
double shape_lift(const Shape& shape, const Wall& wall, const Generator& g, double slope) {
  const ShapeSection s(shape, wall, g);
  if (!(s.from <= s.to)) return -kInfinity;
  const auto support = [&](double rho) { return s.top(rho) - (rho - wall.inner) * slope; };
  return std::max(
      {support(s.from), support(s.to), math::golden_maximum(support, s.from, s.to).value});
}

/// An elbow is not convex: its section is scanned across the wall and refined around the steepest
/// place. What lies between is caught by the table's own proof, not by this.
constexpr int kAcross = 33;

template <class F>
double greatest_across(const joint::PreparedElbow& elbow, const Wall& wall, const Generator& g,
                       double from, F value) {
  std::vector<double> grid, sampled;
  const auto at = [&](double rho) {
    const auto top = joint::shape_top(elbow, {rho, g.cos_phi, g.sin_phi});
    return top ? value(rho, *top) : -kInfinity;
  };
  for (int k = 0; k < kAcross; ++k) {
    grid.push_back(from + (wall.outer - from) * k / (kAcross - 1));
    sampled.push_back(at(grid.back()));
  }
  return math::grid_maximum(at, grid, sampled).value;
}

double elbow_slope(const joint::PreparedElbow& elbow, const Wall& wall, const Generator& g,
                   double z_root) {
  double best = -kInfinity;
  const auto root = joint::shape_top(elbow, g);
  if (root && *root >= z_root - kSameHeight * (wall.outer + std::abs(z_root))) {
    const auto n = joint::elbow_hit(elbow, g).normal;
    best = n.z() > 0.0 ? -n.x() / n.z() : n.x() > 0.0 ? -kInfinity : kInfinity;
  }
  // Nearer to the root than that the slope is lost in the rounding of z, and the root's own holds.
  const double from = wall.inner + 1e-4 * (wall.outer - wall.inner);
  return std::max(best, greatest_across(elbow, wall, g, from, [&](double rho, double z) {
                    return (z - z_root) / (rho - wall.inner);
                  }));
}

double elbow_lift(const joint::PreparedElbow& elbow, const Wall& wall, const Generator& g,
                  double slope) {
  return greatest_across(elbow, wall, g, wall.inner,
                         [&](double rho, double z) { return z - (rho - wall.inner) * slope; });
}

double plane_lift(const PreparedPlane& p, const Wall& wall, const Generator& g, double slope) {
  const double own = p.slope_x * g.cos_phi + p.slope_y * g.sin_phi;
  return p.height + wall.inner * own + std::max(0.0, (wall.outer - wall.inner) * (own - slope));
}

double slope_of(const Prepared& cutter, const Wall& wall, const Generator& g, double z_root) {
  if (const auto* tube = std::get_if<PreparedTube>(&cutter))
    return tube_slope(*tube, wall, g, z_root);
  if (const auto* plane = std::get_if<PreparedPlane>(&cutter))
    return plane_slope(*plane, wall, g, z_root);
  if (const auto* box = std::get_if<joint::PreparedBox>(&cutter))
    return shape_slope(*box, wall, g, z_root);
  if (const auto* cone = std::get_if<joint::PreparedCone>(&cutter))
    return shape_slope(*cone, wall, g, z_root);
  return elbow_slope(std::get<joint::PreparedElbow>(cutter), wall, g, z_root);
}

double lift_of(const Prepared& cutter, const Wall& wall, const Generator& g, double slope) {
  if (const auto* tube = std::get_if<PreparedTube>(&cutter))
    return tube_lift(*tube, wall, g, slope);
  if (const auto* plane = std::get_if<PreparedPlane>(&cutter))
    return plane_lift(*plane, wall, g, slope);
  if (const auto* box = std::get_if<joint::PreparedBox>(&cutter))
    return shape_lift(*box, wall, g, slope);
  if (const auto* cone = std::get_if<joint::PreparedCone>(&cutter))
    return shape_lift(*cone, wall, g, slope);
  return elbow_lift(std::get<joint::PreparedElbow>(cutter), wall, g, slope);
}

}  // namespace

double required_bevel(std::span<const Prepared> cutters, const Wall& wall,
                      const Generator& inner_line, double z_root) {
  double slope = -kInfinity;
  for (const auto& cutter : cutters)
    slope = std::max(slope, slope_of(cutter, wall, inner_line, z_root));
  return elementary::atan(slope);
}

double lift(std::span<const Prepared> cutters, const Wall& wall, const Generator& inner_line,
            double slope) {
  double z = -kInfinity;
  for (const auto& cutter : cutters) z = std::max(z, lift_of(cutter, wall, inner_line, slope));
  return z;
}

}  // namespace tubecut::bevel
