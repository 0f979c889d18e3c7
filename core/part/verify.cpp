#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/math/cylinder.hpp"
#include "core/math/polygon.hpp"
#include "core/math/rotation.hpp"
#include "core/part/hole_volume.hpp"
#include "core/part/part.hpp"
#include "core/part/square_holes.hpp"
#include "core/part/text_clearance.hpp"
#include "core/part/worst_checks.hpp"

namespace tubecut::part {
namespace {

using Eigen::Vector3d;
using math::cylinder_point;

constexpr double kPlaced = 1e-9;  // mm
constexpr double kVolume = 1e-9;  // relative

/// Transforms from the part's frame to the end's own: a shift, and at the finish half a revolution
/// about x.
struct RigidTransform {
  Eigen::Matrix3d turn;
  Vector3d shift;
  Vector3d operator()(const Vector3d& p) const { return turn * p + shift; }
};

/// Checks that every row of the part's table holds the same points as the end's own.
double misplaced(const End& end, bool finish, const RigidTransform& place) {
  const auto& target = end.spec.target;
  const auto n = end.own.phi.size();
  if (end.table.phi.size() != n) return 1.0;
  double worst = 0.0;
  const auto row = [&](std::size_t k, std::size_t i) {
    const auto& a = end.table;
    const auto& b = end.own;
    double off = 0.0;
    const auto pair = [&](double radius, double z, double own) {
      worsen(off,
             (place(cylinder_point(radius, a.phi[k], z)) - cylinder_point(radius, b.phi[i], own))
                 .norm());
    };
    pair(target.inner_radius(), a.z_inner[k], b.z_inner[i]);
    pair(target.outer_radius, a.z_outer[k], b.z_outer[i]);
    pair(target.inner_radius(), a.torch_inner[k], b.torch_inner[i]);
    pair(target.outer_radius, a.torch_outer[k], b.torch_outer[i]);
    // The beam's direction, transformed as the points are.
    const Vector3d radial = cylinder_point(1.0, a.phi[k], 0.0),
                   own = cylinder_point(1.0, b.phi[i], 0.0);
    const auto beam = elementary::sincos(a.b[k]);
    const auto beam_own = elementary::sincos(b.b[i]);
    worsen(off, (place.turn * (beam.cos * radial + beam.sin * Vector3d::UnitZ()) -
                 (beam_own.cos * own + beam_own.sin * Vector3d::UnitZ()))
                    .norm());
    return off;
  };
  const auto zeros = static_cast<std::size_t>(std::ranges::count(end.own.phi, 0.0));
  for (std::size_t k = 0; k < n && !stopped(); ++k) {
    const auto i = !finish ? k : k < zeros ? zeros - 1 - k : n - 1 - (k - zeros);
    worsen(worst, row(k, i));
  }
  return worst;
}

double misplaced(const bevel::Hole& placed, const bevel::Hole& own, double dz) {
  double worst = 0.0;
  for (std::size_t i = 0; i < own.phi.size(); ++i) {
    worsen(worst, std::abs(placed.phi.at(i) - own.phi[i]));
    worsen(worst, std::abs(placed.z.at(i) - dz - own.z[i]));
    worsen(worst, std::abs(placed.z_inner.at(i) - dz - own.z_inner[i]));
    worsen(worst, std::abs(placed.torch_z.at(i) - dz - own.torch_z[i]));
    worsen(worst, std::abs(placed.torch_z_inner.at(i) - dz - own.torch_z_inner[i]));
  }
  return worst;
}

/// Computes a part's volume by the divergence theorem with the field (0, 0, z): only the two cut
/// faces count, each row's sector by Simpson across the wall.
double ruled(const bevel::Table& t, const joint::Target& target, double face) {
  double sum = 0.0;
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const auto j = (i + 1) % t.phi.size();
    const double step = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
    const auto part = [&](double from, double to, double z_from, double z_to) {
      const double middle = 0.5 * (from + to);
      return (to - from) / 6.0 * (from * z_from + 4.0 * middle * 0.5 * (z_from + z_to) + to * z_to);
    };
    const auto mean = [&](const std::vector<double>& z) { return 0.5 * (z[i] + z[j]); };
    const double inner = target.inner_radius(), edge = inner + face;
    if (t.z_face.empty())
      sum += step * part(inner, target.outer_radius, mean(t.z_inner), mean(t.z_outer));
    else
      sum += step * (part(inner, edge, mean(t.z_inner), mean(t.z_face)) +
                     part(edge, target.outer_radius, mean(t.z_face), mean(t.z_outer)));
  }
  return sum;
}

/// Returns the polygon where a hole's lines cross the radius rho: at acos(p / rho) from their feet,
/// p from the axis.
math::Polygon passing(const bevel::Hole& h, const joint::Target& target, double rho) {
  const double inner = target.inner_radius(), outer = target.outer_radius;
  math::Polygon out;
  for (auto* column : {&out.x, &out.y}) column->reserve(h.phi.size());
  for (std::size_t i = 0; i < h.phi.size() && !stops(i); ++i) {
    const Vector3d a = cylinder_point(inner, h.phi_inner[i], 0.0),
                   b = cylinder_point(outer, h.phi[i], 0.0);
    const double turn = a.cross(b).z(), way = (b - a).norm();
    const double p = std::min(std::abs(turn) / way, inner);
    const double round = elementary::acos(p / rho) - elementary::acos(p / inner);
    const double s = (std::sqrt(rho * rho - p * p) - std::sqrt(inner * inner - p * p)) / way;
    out.x.push_back(h.phi_inner[i] + std::copysign(round, turn));
    out.y.push_back(h.z_inner[i] + s * (h.z[i] - h.z_inner[i]));
  }
  return out;
}

/// Returns true if two polygons on the cylinder cannot touch.
bool apart(const math::Polygon& a, const math::Polygon& b) {
  const auto [az, bz] = std::pair{std::ranges::minmax(a.y), std::ranges::minmax(b.y)};
  if (az.min > bz.max || bz.min > az.max) return true;
  const auto [ax, bx] = std::pair{std::ranges::minmax(a.x), std::ranges::minmax(b.x)};
  for (int turn = -2; turn <= 2; ++turn)
    if (ax.min + turn * kTwoPi <= bx.max && bx.min <= ax.max + turn * kTwoPi) return false;
  return true;
}

/// Computes the volume of the holes ring by ring: each line's position from its foot, each group
/// separately.
double holes_by_rings(const PartSpec& spec, const Part& p) {
  double from = -1e300, to = 1e300;
  for (const auto* z : {&p.start.table.z_inner, &p.start.table.z_outer})
    from = std::max(from, std::ranges::max(*z));
  for (const auto* z : {&p.finish.table.z_inner, &p.finish.table.z_outer})
    to = std::min(to, std::ranges::min(*z));
  std::vector<bevel::Hole> holes;
  for (const auto& placed : p.holes) holes.push_back(closer_rows(placed.hole));
  double sum = 0.0;
  for (const auto& ring : wall_rings(spec.target)) {
    std::vector<math::Polygon> all, crowded;
    for (const auto& hole : holes) {
      if (stopped()) return 0.0;
      all.push_back(passing(hole, spec.target, ring.rho));
    }
    for (const auto& polygon : all) {
      if (stopped()) return 0.0;
      const auto [least, most] = std::ranges::minmax(polygon.y);
      const bool alone =
          least > from && most < to && std::ranges::all_of(all, [&](const math::Polygon& other) {
            return &other == &polygon || apart(polygon, other);
          });
      if (alone) {
        double twice = 0.0;  // by the divergence theorem: z over the angle
        for (std::size_t i = 0; i < polygon.x.size(); ++i) {
          const auto j = (i + 1) % polygon.x.size();
          twice += (polygon.x[j] - polygon.x[i]) * (polygon.y[i] + polygon.y[j]);
        }
        sum += ring.weight * 0.5 * std::abs(twice);
        continue;
      }
      for (const double turn : {-kTwoPi, 0.0, kTwoPi}) {
        crowded.push_back(polygon);
        for (double& x : crowded.back().x) x += turn;
      }
    }
    if (!crowded.empty())
      sum += ring.weight * area_between_cuts(spec.target, p, std::move(crowded), ring);
  }
  return sum;
}

double volume_off(const PartSpec& spec, const Part& p) {
  const double volume = ruled(p.finish.table, spec.target, p.finish.spec.root_face) -
                        ruled(p.start.table, spec.target, p.start.spec.root_face) -
                        holes_by_rings(spec, p) - cutout::volume_by_rings(p.cutouts);
  return std::abs(p.lengths.mass / (spec.density * 1e-9) - volume) / std::abs(volume);
}

/// Returns the error of an outside length at phi, by a separate search in the answer's rows.
double quarter_off(const Part& p, const CheckDimension& d, double phi) {
  const auto height = [&](const bevel::Table& t, bool high) {
    double best = 0.0;
    bool met = false;
    for (std::size_t i = 0; i < t.phi.size(); ++i) {
      const auto j = (i + 1) % t.phi.size();
      const double to = t.phi[j] + (j == 0 ? kTwoPi : 0.0);
      for (const double here : {phi, phi + kTwoPi}) {
        if (here < t.phi[i] || here > to) continue;
        const double span = to - t.phi[i];
        const double z =
            span > 0.0 ? t.z_outer[i] + (here - t.phi[i]) / span * (t.z_outer[j] - t.z_outer[i])
                       : t.z_outer[i];
        best = !met ? z : high ? std::max(best, z) : std::min(best, z);
        met = true;
      }
    }
    return best;
  };
  return std::abs(height(p.finish.table, false) - height(p.start.table, true) - d.value);
}

double dimensions_off(const PartSpec& spec, const Part& p) {
  double worst = 0.0;
  for (const auto& d : p.check_dimensions) {
    if (d.name == "girth") worsen(worst, std::abs(d.value - kPi * 2.0 * spec.target.outer_radius));
    for (int k = 0; k < 4; ++k)
      if (d.name == "length_at_" + std::to_string(90 * k))
        worsen(worst, quarter_off(p, d, 0.5 * kPi * k));
  }
  return worst;
}

}  // namespace

std::vector<Check> verify(const PartSpec& spec, const Part& part) {
  WorstChecks all;
  all.see(bevel::verify(part.start.spec, part.start.own), "");
  all.see(bevel::verify(part.finish.spec, part.finish.own), "");
  for (std::size_t i = 0; i < part.hole_cuts.size(); ++i)
    all.see(bevel::verify(part.hole_specs[i], part.hole_cuts[i]), "hole_");
  auto out = all.take();
  if (!part.cutouts.empty())
    for (auto& check : cutout::verify(part.cutouts, cutout_ground(spec, part)))
      out.push_back(std::move(check));
  for (auto& check : verify_square_holes(spec, part)) out.push_back(std::move(check));
  for (auto& check : verify_texts(part)) out.push_back(std::move(check));
  const Vector3d start = spec.start_frame.rows * (part.frame.origin - spec.start_frame.origin);
  const double length = *spec.target.length;
  Eigen::Matrix3d over = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const double scale = spec.target.outer_radius + length;
  double placed = 0.0;
  worsen(placed, misplaced(part.start, false, {Eigen::Matrix3d::Identity(), start}));
  worsen(placed, misplaced(part.finish, true, {over, {0.0, 0.0, length - start.z()}}));
  for (const auto& hole : part.holes) {
    if (stopped()) break;
    const auto& cut = part.hole_cuts[hole.asked];
    const auto& own = cut.holes[hole.hole.far && cut.holes.size() > 1 ? 1 : 0];
    worsen(placed, misplaced(hole.hole, own, -start.z()));
  }
  out.push_back({"placed", placed, kPlaced * std::max(1.0, 1e-3 * scale), "mm"});
  out.push_back({"volume", volume_off(spec, part), kVolume, ""});
  out.push_back({"check_dimensions", dimensions_off(spec, part),
                 kPlaced * std::max(1.0, 1e-3 * scale), "mm"});
  return out;
}

}  // namespace tubecut::part
