#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/hole/hole_fit.hpp"
#include "core/joint/placement.hpp"
#include "core/math/cylinder.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;
using math::cylinder_point;

constexpr double kLength = 1e-6;     // mm
constexpr double kWallAngle = 1e-6;  // deg
constexpr int kWallLines = 9;

/// A straight line in space; distances come from the component perpendicular to it.
struct WallAxis {
  Vector3d point, direction;
  [[nodiscard]] Vector3d beside(const Vector3d& p) const {
    const Vector3d from = p - point;
    return from - from.dot(direction) * direction;
  }
  [[nodiscard]] double distance(const Vector3d& p) const { return beside(p).norm(); }
};

double between(const Vector3d& a, const Vector3d& b) {
  return 2.0 * elementary::atan2((a - b).norm(), (a + b).norm());
}

struct Proof {
  double root = 0.0, gap = 0.0, fit = 0.0, dihedral = 0.0, groove = 0.0, tilt = 0.0, kerf = 0.0,
         end = 0.0;
};

/// One node of a hole, rebuilt in space. `root`: where the wall meets the branch; for a wall square
/// to the chord, anywhere across it.
struct Row {
  Vector3d outer, inner, root, torch_outer, torch_inner;
  Vector3d chord_normal, branch_normal;
};

/// Returns the point between two points that is nearest to an axis.
Vector3d nearest(const Vector3d& a, const Vector3d& b, const WallAxis& axis) {
  const Vector3d from = axis.beside(a), way = axis.beside(b) - from;
  const double square = way.squaredNorm();
  return a + (square > 0.0 ? std::clamp(-from.dot(way) / square, 0.0, 1.0) : 0.0) * (b - a);
}

Row row(const HoleSpec& spec, const Hole& h, const WallAxis& axis, std::size_t i) {
  Row r;
  const double ro = spec.chord.outer_radius, ri = spec.chord.inner_radius();
  r.outer = cylinder_point(ro, h.phi[i], h.z[i]);
  r.inner = cylinder_point(ri, h.phi_inner[i], h.z_inner[i]);
  r.torch_outer = cylinder_point(ro, h.torch_phi[i], h.torch_z[i]);
  r.torch_inner = cylinder_point(ri, h.torch_phi_inner[i], h.torch_z_inner[i]);
  const bool on = spec.kind == JointKind::set_on;
  r.root = on ? r.outer : r.inner;
  r.chord_normal = cylinder_point(1.0, on ? h.phi[i] : h.phi_inner[i], 0.0);
  if (!on && spec.tilt == Tilt::none) {
    r.root = nearest(r.inner, r.outer, axis);
    r.chord_normal = Vector3d(r.root.x(), r.root.y(), 0.0).normalized();
  }
  r.branch_normal = axis.beside(r.root).normalized();
  return r;
}

/// Checks groove, tilt and kerf of the wall's line.
void prove_wall(const HoleSpec& spec, const Hole& h, const Row& r, std::size_t i, Proof& p) {
  worsen(p.dihedral,
         std::abs(between(r.chord_normal, -r.branch_normal) - h.dihedral[i]) * kDegPerRad);
  const Vector3d wall = (r.outer - r.inner).normalized();
  const Vector3d along = r.chord_normal.cross(r.branch_normal).normalized();
  Vector3d cut = along.cross(wall).normalized();
  if (cut.dot(r.branch_normal) < 0.0) cut = -cut;
  const double side = wall.dot(r.branch_normal) < 0.0 ? -1.0 : 1.0;
  worsen(p.groove, std::abs(side * between(cut, r.branch_normal) - h.groove[i]) * kDegPerRad);
  const double off_outer = (r.outer - r.torch_outer).dot(cut);
  const double off_inner = (r.inner - r.torch_inner).dot(cut);
  worsen(p.kerf, 0.5 * spec.kerf - std::min(off_outer, off_inner));
  // A head that does not tilt is square at its own position: not exactly parallel to the wall.
  if (spec.tilt != Tilt::none) worsen(p.kerf, std::abs(off_outer - off_inner));
  const Vector3d torch = r.torch_outer - r.torch_inner;
  const auto at = elementary::sincos(h.torch_phi[i]);
  const double height = torch.x() * at.cos + torch.y() * at.sin;
  const double across = torch.y() * at.cos - torch.x() * at.sin;
  worsen(p.tilt, std::abs(elementary::atan2(torch.z(), height) - h.b[i]) * kDegPerRad);
  worsen(p.tilt, std::abs(elementary::atan2(across, height) - h.a[i]) * kDegPerRad);
}

/// Checks that a set-on hole cut with free tilt is the branch's extended bore, if the torch can
/// lean that far.
void prove_bore(const HoleSpec& spec, const Row& r, const WallAxis& axis, double rho, Proof& p) {
  const double lean = between(r.chord_normal, axis.direction.normalized());
  if (spec.tilt == Tilt::free && lean <= spec.torch.max.rad())
    worsen(p.root, std::abs(axis.distance(r.inner) - rho));
}

/// Checks the hole's wall against the branch.
void prove_clearance(const HoleSpec& spec, const Hole& h, const Row& r, const WallAxis& axis,
                     double branch_radius, std::size_t i, Proof& p) {
  worsen(p.gap, std::abs(axis.distance(r.root) - branch_radius - spec.gap));
  for (int k = 0; k < kWallLines; ++k) {
    const double t = static_cast<double>(k) / (kWallLines - 1);
    worsen(p.gap, spec.gap + branch_radius - axis.distance((1.0 - t) * r.inner + t * r.outer));
  }
  worsen(p.fit, std::abs(axis.distance(r.inner) - branch_radius - h.fit.root[i]));
  worsen(p.fit, std::abs(axis.distance(r.outer) - branch_radius - h.fit.face[i]));
}

/// Checks the branch's end against the chord, in the branch's own frame.
void prove_end(const HoleSpec& spec, const joint::TubeCutter& branch, const BranchEnd& end,
               const FitUp& fit, Proof& p) {
  const auto line = joint::axis_of(end.chord);
  const WallAxis axis{line.point, line.direction};
  const double outer = branch.radius, inner = branch.radius - spec.branch_wall;
  const bool on = spec.kind == JointKind::set_on;
  const double seat = on ? spec.chord.outer_radius + spec.gap
                         : spec.chord.outer_radius - spec.depth.value_or(spec.chord.wall);
  for (std::size_t i = 0; i < end.phi.size() && !stopped(); ++i) {
    const Vector3d root = cylinder_point(inner, end.phi[i], end.z_inner[i]);
    const Vector3d face = cylinder_point(outer, end.phi[i], end.z_outer[i]);
    worsen(p.end, std::abs(axis.distance(root) - seat));
    worsen(p.tilt, std::abs(elementary::atan2(end.z_outer[i] - end.z_inner[i], spec.branch_wall) -
                            end.b[i]) *
                       kDegPerRad);
    for (int k = 0; k < kWallLines; ++k) {
      const double t = static_cast<double>(k) / (kWallLines - 1);
      worsen(p.gap, seat - axis.distance((1.0 - t) * root + t * face));
    }
    // If set in, it is flush: in the seat's tangent plane at the root.
    if (!on && end.b[i] > spec.torch.min.rad())
      worsen(p.end, std::abs((face - root).dot(axis.beside(root).normalized())));
    if (!on) continue;
    worsen(p.fit, std::abs(axis.distance(root) - spec.chord.outer_radius - fit.root[i]));
    worsen(p.fit, std::abs(axis.distance(face) - spec.chord.outer_radius - fit.face[i]));
  }
}

/// Returns the worst of each check of the torch's lines over the holes.
std::vector<Check> torch_checks(const HoleSpec& spec, const HoleCut& cut) {
  std::vector<Check> out;
  for (const auto& h : cut.holes) {
    auto checks = verify_torch_line(beam_cut(spec, h), h.torch_line);
    if (out.empty()) {
      out = std::move(checks);
      continue;
    }
    for (std::size_t i = 0; i < out.size(); ++i)
      if (checks[i].value * out[i].limit > out[i].value * checks[i].limit) out[i] = checks[i];
  }
  return out;
}

}  // namespace

std::vector<Check> verify(const HoleSpec& spec, const HoleCut& cut) {
  const auto branch = branch_tube(spec.branch);
  if (!branch) return {};
  const auto line = joint::axis_of(*branch);
  const WallAxis axis{line.point, line.direction};
  const bool on = spec.kind == JointKind::set_on;
  const double rho = on ? branch->radius - spec.branch_wall : branch->radius + spec.gap;
  Proof p;
  for (const auto& h : cut.holes)
    for (std::size_t i = 0; i < h.phi.size() && !stopped(); ++i) {
      const auto r = row(spec, h, axis, i);
      worsen(p.root, std::abs(axis.distance(r.root) - rho));
      prove_wall(spec, h, r, i, p);
      if (on)
        prove_bore(spec, r, axis, rho, p);
      else
        prove_clearance(spec, h, r, axis, branch->radius, i, p);
    }
  if (cut.branch) prove_end(spec, *branch, *cut.branch, cut.holes.front().fit, p);
  std::vector<Check> out{
      {"on_branch", p.root, kLength, "mm"},    {"gap", p.gap, kLength, "mm"},
      {"fit_up", p.fit, kLength, "mm"},        {"dihedral", p.dihedral, kWallAngle, "deg"},
      {"groove", p.groove, kWallAngle, "deg"}, {"tilt", p.tilt, kWallAngle, "deg"},
      {"kerf", p.kerf, kLength, "mm"},         {"branch_end", p.end, kLength, "mm"}};
  for (auto& check : nearest_checks(spec, *branch, cut)) out.push_back(std::move(check));
  for (auto& check : torch_checks(spec, cut)) out.push_back(std::move(check));
  return out;
}

}  // namespace tubecut::bevel
