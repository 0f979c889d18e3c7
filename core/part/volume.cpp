#include "core/part/volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/joint/contour.hpp"
#include "core/math/quadrature.hpp"
#include "core/part/edge.hpp"

namespace tubecut::part {
namespace {

constexpr int kAcross = 6;  // Gauss points across the wall

/// Radii of the edges across the wall, and where they lie.
struct Rings {
  std::vector<double> radii;
  std::vector<Edge> edges;
};

Rings rings(const bevel::TableSpec& spec, const bevel::Table& t) {
  const auto& target = spec.target;
  Rings out{{target.inner_radius()}, {{t.phi, t.z_inner}}};
  if (!t.z_face.empty()) {
    out.radii.push_back(target.inner_radius() + spec.root_face);
    out.edges.push_back({t.phi, t.z_face});
  }
  out.radii.push_back(target.outer_radius);
  out.edges.push_back({t.phi, t.z_outer});
  return out;
}

/// The cut's z at radius rho of row i.
double cut_at(const Rings& rings, std::size_t i, double rho) {
  std::size_t k = 0;
  while (k + 2 < rings.radii.size() && rho > rings.radii[k + 1]) ++k;
  const double u = (rho - rings.radii[k]) / (rings.radii[k + 1] - rings.radii[k]);
  return (1.0 - u) * rings.edges[k].z[i] + u * rings.edges[k + 1].z[i];
}

}  // namespace

double end_volume(const bevel::TableSpec& spec, const bevel::Table& table) {
  const auto r = rings(spec, table);
  return ring_volume(r.radii, r.edges);
}

double groove_volume(const bevel::TableSpec& spec, const bevel::Table& table) {
  const auto cutters = joint::resolve(spec.partners);
  if (!cutters) return 0.0;
  std::vector<joint::Prepared> prepared;
  for (const auto& cutter : *cutters)
    if (auto one = joint::prepare(cutter, "")) prepared.push_back(*one);
  const auto r = rings(spec, table);
  const auto rule = math::gauss_legendre(kAcross);
  Edge across{table.phi, std::vector<double>(table.phi.size(), 0.0)};
  for (std::size_t i = 0; i < table.phi.size(); ++i)
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double rho =
          spec.target.inner_radius() + 0.5 * (1.0 + rule.nodes[k]) * spec.target.wall;
      const auto top = joint::highest(prepared, joint::generator_at(rho, table.phi[i]));
      if (!top) continue;
      const auto& stated = bevel::stated_joint(spec, top->cutter);
      if (stated && stated->kind == joint::JointKind::set_in) continue;
      across.z[i] += 0.5 * rule.weights[k] * spec.target.wall * rho *
                     std::max(0.0, cut_at(r, i, rho) - top->z);
    }
  return across.turn_integral();
}

}  // namespace tubecut::part
