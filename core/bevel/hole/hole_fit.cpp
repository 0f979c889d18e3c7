#include "core/bevel/hole/hole_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/joint/placement.hpp"
#include "core/joint/solid.hpp"
#include "core/math/cylinder.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;
using math::cylinder_point;

constexpr int kAcross = 5;                               // points across the wall
constexpr std::array kBetween = {0.0, 0.25, 0.5, 0.75};  // from one node to the next

/// Both edges of a cut wall at one position: phase and height on the root's surface and on the
/// other.
struct Edges {
  double root_phi, root_z, face_phi, face_z;
};

Edges mixed(const Edges& a, const Edges& b, double t) {
  return {math::mixed(a.root_phi, b.root_phi, t), math::mixed(a.root_z, b.root_z, t),
          math::mixed(a.face_phi, b.face_phi, t), math::mixed(a.face_z, b.face_z, t)};
}

struct Gaps {
  double root, face, least;
};

/// A wall between two surfaces of revolution and the solid that faces it.
struct Facing {
  double root_radius, face_radius;
  joint::Solid solid;

  [[nodiscard]] Gaps at(const Edges& e) const {
    const Vector3d root = cylinder_point(root_radius, e.root_phi, e.root_z);
    const Vector3d face = cylinder_point(face_radius, e.face_phi, e.face_z);
    Gaps out{solid.distance(root), solid.distance(face), std::numeric_limits<double>::infinity()};
    for (int k = 0; k < kAcross; ++k) {
      const double t = static_cast<double>(k) / (kAcross - 1);
      out.least = std::min(out.least, solid.distance((1.0 - t) * root + t * face));
    }
    return out;
  }
};

Facing facing(const HoleSpec& spec, const joint::TubeCutter& branch) {
  if (spec.kind == JointKind::set_on)
    return {branch.radius - spec.branch_wall, branch.radius,
            joint::Solid(joint::Cutter(chord_seen_from(branch, spec.chord.outer_radius)))};
  return {spec.chord.inner_radius(), spec.chord.outer_radius, joint::Solid(joint::Cutter(branch))};
}

std::vector<Edges> edges(const HoleSpec& spec, const HoleCut& cut, const Hole& hole) {
  std::vector<Edges> out;
  for (std::size_t i = 0; i < hole.phi.size(); ++i) {
    if (spec.kind == JointKind::set_on)
      out.push_back({cut.branch->phi.at(i), cut.branch->z_inner.at(i), cut.branch->phi.at(i),
                     cut.branch->z_outer.at(i)});
    else
      out.push_back({hole.phi_inner[i], hole.z_inner[i], hole.phi[i], hole.z[i]});
  }
  auto closing = out.front();
  if (spec.kind == JointKind::set_on) {
    closing.root_phi += kTwoPi;
    closing.face_phi += kTwoPi;
  }
  out.push_back(closing);
  return out;
}

/// Returns the hole's wall by its edges, or the branch's.
CutWall wall_of(const HoleSpec& spec, const Hole& hole) {
  return {.edges = {{spec.chord.inner_radius(), hole.phi_inner, hole.z_inner},
                    {spec.chord.outer_radius, hole.phi, hole.z}},
          .turn = 0.0};
}

CutWall wall_of(const HoleSpec& spec, const joint::TubeCutter& branch, const BranchEnd& end) {
  return {.edges = {{branch.radius - spec.branch_wall, end.phi, end.z_inner},
                    {branch.radius, end.phi, end.z_outer}},
          .turn = kTwoPi};
}

/// Returns the wall that faces the other member.
CutWall facing_wall(const HoleSpec& spec, const joint::TubeCutter& branch, const HoleCut& cut,
                    const Hole& hole) {
  return spec.kind == JointKind::set_on ? wall_of(spec, branch, *cut.branch) : wall_of(spec, hole);
}

/// Returns the solid that it faces, grown by the requested gap.
joint::TubeCutter other_member(const HoleSpec& spec, const joint::TubeCutter& branch) {
  auto out =
      spec.kind == JointKind::set_on ? chord_seen_from(branch, spec.chord.outer_radius) : branch;
  out.radius += spec.gap;
  return out;
}

Penetration nearest(const HoleSpec& spec, const joint::TubeCutter& branch, const HoleCut& cut,
                    const Hole& hole) {
  constexpr double kSlack = 3e-4;  // mm
  const joint::Solid other{joint::Cutter(other_member(spec, branch))};
  auto out = deepest(facing_wall(spec, branch, cut, hole), {&other, 1}, kSlack);
  out.depth = std::max(0.0, out.depth);
  return out;
}

/// Returns how much nearer than the requested gap a point is, by its distance to the other member's
/// axis.
double nearer(const joint::TubeCutter& other, const Vector3d& place) {
  const auto line = joint::axis_of(other);
  return other.radius - (place - line.point).cross(line.direction).norm();
}

/// Returns the largest depth at a fixed set of points between the rows: in the middle and at one
/// more position by the golden ratio, at both edges and once between them.
double sampled(const CutWall& wall, const joint::TubeCutter& other) {
  constexpr double kGolden = 0.6180339887498949;
  double deepest = 0.0, seed = 0.0;
  const auto next = [&] { return seed = seed + kGolden - std::floor(seed + kGolden); };
  for (std::size_t i = 0; i < wall.gaps() && !stopped(); ++i)
    for (const double share : {0.5, next()}) {
      const auto j = (i + 1) % wall.gaps();
      const auto on = [&](const WallEdge& e) {
        const double to = e.phi[j] + (j == 0 ? wall.turn : 0.0);
        return cylinder_point(e.radius, e.phi[i] + share * (to - e.phi[i]),
                              e.z[i] + share * (e.z[j] - e.z[i]));
      };
      const Vector3d low = on(wall.edges[0]), high = on(wall.edges[1]);
      for (const double across : {0.0, next(), 1.0}) {
        const double depth = nearer(other, low + across * (high - low));
        worsen(deepest, depth);
      }
    }
  return deepest;
}

}  // namespace

joint::TubeCutter chord_seen_from(const joint::TubeCutter& branch, double radius) {
  return {.radius = radius,
          .inclination = branch.inclination,
          .clocking = {},
          .offset = branch.offset,
          .height = 0.0};
}

std::vector<bool> too_near_between(const HoleSpec& spec, const joint::TubeCutter& branch,
                                   const Hole& hole) {
  const joint::Solid other{joint::Cutter(other_member(spec, branch))};
  return entering(wall_of(spec, hole), {&other, 1}, spec.sampling.tolerance->value);
}

std::vector<bool> too_near_between(const HoleSpec& spec, const joint::TubeCutter& branch,
                                   const BranchEnd& end) {
  const joint::Solid other{joint::Cutter(other_member(spec, branch))};
  return entering(wall_of(spec, branch, end), {&other, 1}, spec.sampling.tolerance->value);
}

FitUp fit_up(const HoleSpec& spec, const joint::TubeCutter& branch, const HoleCut& cut,
             const Hole& hole) {
  const auto wall = facing(spec, branch);
  const auto all = edges(spec, cut, hole);
  FitUp out;
  out.greatest_root_between = -std::numeric_limits<double>::infinity();
  out.nearest = nearest(spec, branch, cut, hole);
  out.least_between = spec.gap - out.nearest.depth;
  for (std::size_t i = 0; i + 1 < all.size() && !stopped(); ++i) {
    for (const double t : kBetween) {
      const auto gaps = wall.at(mixed(all[i], all[i + 1], t));
      if (t == 0.0) {
        out.root.push_back(gaps.root);
        out.face.push_back(gaps.face);
        out.least.push_back(gaps.least);
      }
      out.greatest_root_between = std::max(out.greatest_root_between, gaps.root);
    }
  }
  return out;
}

void note_nearest(const HoleSpec& spec, HoleCut& cut) {
  if (spec.sampling.tolerance) return;
  for (const auto& hole : cut.holes) {
    const auto& p = hole.fit.nearest;
    if (!(p.depth > joint::Tolerance{}.value)) continue;
    cut.warnings.push_back({.code = WarningCode::enters_partner,
                            .member = "branch",
                            .detail = "nearer than the requested gap by up to " + brief(p.depth) +
                                      " mm between points, at phi " + brief(p.phi * kDegPerRad) +
                                      " deg, radius " + brief(p.radius) + " mm, z " + brief(p.z) +
                                      " mm"});
  }
}

std::vector<Check> nearest_checks(const HoleSpec& spec, const joint::TubeCutter& branch,
                                  const HoleCut& cut) {
  constexpr double kStated = 1e-3;  // mm
  const auto other = other_member(spec, branch);
  double off = 0.0, deepest = 0.0;
  for (const auto& hole : cut.holes) {
    const auto& p = hole.fit.nearest;
    const double there = worst_of({0.0, nearer(other, cylinder_point(p.radius, p.phi, p.z))});
    const double found = sampled(facing_wall(spec, branch, cut, hole), other);
    off = worst_of({off, std::abs(there - p.depth), found - p.depth});
    deepest = worst_of({deepest, p.depth, found});
  }
  std::vector<Check> out{{"gap_stated", off, kStated, "mm"}};
  if (spec.sampling.tolerance)
    out.push_back({"gap_between", deepest, spec.sampling.tolerance->value, "mm"});
  return out;
}

}  // namespace tubecut::bevel
