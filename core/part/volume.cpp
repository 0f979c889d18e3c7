#include "core/part/volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/stop.hpp"
#include "core/joint/contour.hpp"
#include "core/math/quadrature.hpp"
#include "core/part/edge.hpp"

namespace tubecut::part {
namespace {

constexpr int kAcross = 6;  // Gauss points across the wall, or a part of it
constexpr int kAlong = 3;   // and along each segment from row to row
constexpr double kPiece =
    3.0 * kRadPerDeg;  // maximum length, because a partner bends little over it

/// Radii of the edges across the wall, and their fractions.
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

/// Height of the cut above its partners' metal; 0 below it, and if there is no metal.
class Depth {
 public:
  explicit Depth(const bevel::TableSpec& spec, std::vector<joint::PreparedCutter> partners)
      : spec_(spec), partners_(std::move(partners)) {}

  [[nodiscard]] double operator()(double rho, double phi, double z) const {
    const auto top = joint::highest(partners_, joint::generator_at(rho, phi));
    if (!top) return 0.0;
    const auto& stated = bevel::stated_joint(spec_, top->cutter);
    if (stated && stated->kind == joint::JointKind::set_in) return 0.0;
    return std::max(0.0, z - top->z);
  }

 private:
  const bevel::TableSpec& spec_;
  std::vector<joint::PreparedCutter> partners_;
};

/// Integrates the depth over the area between two edges of the wall in one half plane, per radian:
/// straight from z0 at rho0 to z1 at rho1.
double across(const Depth& depth, double phi, const std::array<double, 2>& rho,
              const std::array<double, 2>& z) {
  static const auto rule = math::gauss_legendre(kAcross);
  const double wide = rho[1] - rho[0];
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double u = 0.5 * (1.0 + rule.nodes[k]), at = rho[0] + u * wide;
    sum += 0.5 * rule.weights[k] * wide * at * depth(at, phi, (1.0 - u) * z[0] + u * z[1]);
  }
  return sum;
}

}  // namespace

double end_volume(const bevel::TableSpec& spec, const bevel::Table& table) {
  const auto r = rings(spec, table);
  return ring_volume(r.radii, r.edges);
}

double groove_volume(const bevel::TableSpec& spec, const bevel::Table& table) {
  const auto cutters = joint::resolve(spec.partners);
  if (!cutters) return 0.0;
  std::vector<joint::PreparedCutter> prepared;
  for (const auto& cutter : *cutters)
    if (auto one = joint::prepare(cutter)) prepared.push_back(*one);
  static const auto rule = math::gauss_legendre(kAlong);
  const auto r = rings(spec, table);
  const Depth depth(spec, std::move(prepared));
  double sum = 0.0;
  for (std::size_t i = 0; i < table.phi.size() && !stopped(); ++i) {
    const auto j = (i + 1) % table.phi.size();
    const double step = table.phi[j] - table.phi[i] + (j == 0 ? kTwoPi : 0.0);
    const int pieces = static_cast<int>(std::ceil(step / kPiece));
    for (int piece = 0; piece < pieces && !stopped(); ++piece)
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        const double u = (piece + 0.5 * (1.0 + rule.nodes[k])) / pieces;
        const auto z = [&](std::size_t ring) {
          return (1.0 - u) * r.edges[ring].z[i] + u * r.edges[ring].z[j];
        };
        for (std::size_t ring = 0; ring + 1 < r.radii.size(); ++ring)
          sum += 0.5 * rule.weights[k] * step / pieces *
                 across(depth, table.phi[i] + u * step, {r.radii[ring], r.radii[ring + 1]},
                        {z(ring), z(ring + 1)});
      }
  }
  return sum;
}

}  // namespace tubecut::part
