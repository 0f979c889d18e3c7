#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/stop.hpp"
#include "core/joint/contour.hpp"
#include "core/joint/section/section_place.hpp"
#include "core/math/mixed.hpp"
#include "core/math/quadrature.hpp"
#include "core/part/section/section_part.hpp"
#include "core/part/section/section_strips.hpp"

namespace tubecut::part {
namespace {

using bevel::SectionSurface;

constexpr int kPlacesAlong = 6;   // Gauss points along a smooth strip
constexpr int kPlacesAcross = 6;  // and across the wall, or a part of it
constexpr int kPieces = 120;      // of the girth: a partner bends little over one

/// Integrates z over a line across the wall whose area grows outwards: between two depths, z
/// straight.
double across(double kappa, double deep, double z_deep, double shallow, double z_shallow) {
  const double wide = deep - shallow;
  // z and 1 - kappa e are linear in the depth e: Simpson is exact for their product.
  const auto value = [&](double share) {
    return math::mixed(z_shallow, z_deep, share) * (1.0 - kappa * (shallow + share * wide));
  };
  return wide / 6.0 * (value(0.0) + 4.0 * value(0.5) + value(1.0));
}

double under_line(const SectionSurface& surface, const SectionSurface::Line& line) {
  const double land = line.wall - surface.land();  // depth of the land's outer edge
  double out = across(line.at.curvature, land, line.face, 0.0, line.outer);
  if (surface.land() > 0.0)
    out += across(line.at.curvature, line.wall, line.inner, land, line.face);
  return out;
}

/// Places of a smooth strip, not at its ends, because curvature jumps there.
template <class F>
void each_place(const SectionSurface& surface, std::size_t row, double from, double to, int count,
                F f) {
  const auto rule = math::gauss_legendre(count);
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double share = from + 0.5 * (1.0 + rule.nodes[k]) * (to - from);
    f(surface.line(row, share), 0.5 * rule.weights[k] * (to - from) * surface.width(row));
  }
}

/// Height of the cut above its partners' metal; 0 below it, and if there is no metal.
double depth_at(const bevel::TableSpec& spec, const std::vector<joint::PreparedCutter>& partners,
                const Eigen::Vector3d& place) {
  const auto top = joint::highest(partners, joint::generator_through(place.head<2>()));
  if (!top) return 0.0;
  const auto& stated = bevel::stated_joint(spec, top->cutter);
  if (stated && stated->kind == joint::JointKind::set_in) return 0.0;
  return std::max(0.0, place.z() - top->z);
}

}  // namespace

double end_volume(const section::Wall& wall, const bevel::TableSpec& spec,
                  const bevel::SectionTable& table) {
  const SectionSurface surface(wall, spec, table);
  double sum = 0.0;
  each_smooth_strip(surface, [&](std::size_t row, double from, double to) {
    each_place(surface, row, from, to, kPlacesAlong,
               [&](const SectionSurface::Line& line, double weight) {
                 sum += weight * under_line(surface, line);
               });
  });
  return sum;
}

double groove_volume(const section::Wall& wall, const bevel::TableSpec& spec,
                     const bevel::SectionTable& table) {
  const auto cutters = joint::resolve(spec.partners);
  if (!cutters) return 0.0;
  std::vector<joint::PreparedCutter> partners;
  for (const auto& cutter : *cutters)
    if (auto one = joint::prepare(cutter)) partners.push_back(*one);
  const auto rule = math::gauss_legendre(kPlacesAcross);
  const SectionSurface surface(wall, spec, table);
  const double piece = table.girth / kPieces;
  double sum = 0.0;
  const auto between = [&](const SectionSurface::Line& line, double deep, double shallow) {
    double out = 0.0;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double depth = math::mixed(shallow, deep, 0.5 * (1.0 + rule.nodes[k]));
      const auto place = SectionSurface::place(line, depth, surface.z(line, depth));
      out += 0.5 * rule.weights[k] * (deep - shallow) * (1.0 - line.at.curvature * depth) *
             depth_at(spec, partners, place);
    }
    return out;
  };
  each_smooth_strip(surface, [&](std::size_t row, double from, double to) {
    const int pieces =
        std::max(1, static_cast<int>(std::ceil((to - from) * surface.width(row) / piece)));
    for (int i = 0; i < pieces && !stopped(); ++i)
      each_place(surface, row, math::mixed(from, to, static_cast<double>(i) / pieces),
                 math::mixed(from, to, static_cast<double>(i + 1) / pieces), 3,
                 [&](const SectionSurface::Line& line, double weight) {
                   const double land = line.wall - surface.land();
                   sum += weight * (between(line, land, 0.0) +
                                    (surface.land() > 0.0 ? between(line, line.wall, land) : 0.0));
                 });
  });
  return sum;
}

}  // namespace tubecut::part
