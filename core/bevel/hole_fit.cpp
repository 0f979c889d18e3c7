#include "core/bevel/hole_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/joint/solid.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;

constexpr int kAcross = 5;                               // points across the wall
constexpr std::array kBetween = {0.0, 0.25, 0.5, 0.75};  // from one node to the next

/// Both edges of a cut wall at one place: phase and height on the root's surface and on the other.
struct Edges {
  double root_phi, root_z, face_phi, face_z;
};

Edges mixed(const Edges& a, const Edges& b, double t) {
  const auto mix = [t](double x, double y) { return (1.0 - t) * x + t * y; };
  return {mix(a.root_phi, b.root_phi), mix(a.root_z, b.root_z), mix(a.face_phi, b.face_phi),
          mix(a.face_z, b.face_z)};
}

Vector3d placed(double radius, double phi, double z) {
  const auto at = elementary::sincos(phi);
  return {radius * at.cos, radius * at.sin, z};
}

struct Gaps {
  double root, face, least;
};

/// A wall between two surfaces of revolution and the solid that faces it.
struct Facing {
  double root_radius, face_radius;
  joint::Solid solid;

  [[nodiscard]] Gaps at(const Edges& e) const {
    const Vector3d root = placed(root_radius, e.root_phi, e.root_z);
    const Vector3d face = placed(face_radius, e.face_phi, e.face_z);
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

}  // namespace

joint::TubeCutter chord_seen_from(const joint::TubeCutter& branch, double radius) {
  return {.radius = radius,
          .inclination = branch.inclination,
          .clocking = {},
          .offset = branch.offset,
          .height = 0.0};
}

FitUp fit_up(const HoleSpec& spec, const joint::TubeCutter& branch, const HoleCut& cut,
             const Hole& hole) {
  const auto wall = facing(spec, branch);
  const auto all = edges(spec, cut, hole);
  FitUp out;
  out.least_between = std::numeric_limits<double>::infinity();
  out.greatest_root_between = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    for (const double t : kBetween) {
      const auto gaps = wall.at(mixed(all[i], all[i + 1], t));
      if (t == 0.0) {
        out.root.push_back(gaps.root);
        out.face.push_back(gaps.face);
        out.least.push_back(gaps.least);
      }
      out.least_between = std::min(out.least_between, gaps.least);
      out.greatest_root_between = std::max(out.greatest_root_between, gaps.root);
    }
  }
  return out;
}

}  // namespace tubecut::bevel
