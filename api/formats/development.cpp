#include "api/formats/development.hpp"

#include <algorithm>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

/// A table's column as a curve from the seam at phi = 0 to the seam at 2 pi.
CylinderCurve round_the_tube(double radius, std::vector<double> phi, std::vector<double> z) {
  if (phi.empty()) return {};
  const double ahead = phi.front() + kTwoPi - phi.back();
  const double share = ahead > 0.0 ? phi.front() / ahead : 0.0;  // of the step across the seam
  const double seam = z.front() + share * (z.back() - z.front());
  if (phi.front() > 0.0) {
    phi.insert(phi.begin(), 0.0);
    z.insert(z.begin(), seam);
  }
  if (phi.back() < kTwoPi) {
    phi.push_back(kTwoPi);
    z.push_back(seam);
  }
  return {.radius = radius, .phi = std::move(phi), .z = std::move(z)};
}

CylinderCurve profile_curve(const joint::Profile& p) {
  return round_the_tube(p.radius, p.phi, p.z);
}

}  // namespace

double CylinderCurve::developed_length(bool closing) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const auto next = i + 1 == phi.size() ? 0 : i + 1;
    if (next == 0 && !closing) break;
    sum += elementary::hypot(radius * (phi[next] - phi[i]), z[next] - z[i]);
  }
  return sum;
}

Development developed(const bevel::TableSpec& spec, const bevel::Table& t) {
  const double outer = spec.target.outer_radius, inner = spec.target.inner_radius();
  Development out{.outer_radius = outer, .wall = spec.target.wall, .cuts = {}, .junctions = {}};
  out.cuts.push_back({.name = "cut end",
                      .outer = round_the_tube(outer, t.phi, t.z_outer),
                      .inner = round_the_tube(inner, t.phi, t.z_inner),
                      .torch = round_the_tube(outer, t.phi, t.torch_outer)});
  const bool outer_root = spec.root_surface == bevel::RootSurface::outer;
  for (const auto& event : outer_root ? t.outer_events : t.inner_events)
    out.junctions.push_back(event.phi);
  return out;
}

Development developed(const joint::IntersectionSpec& spec, const joint::Intersection& cut) {
  Development out{.outer_radius = spec.target.outer_radius,
                  .wall = spec.target.wall,
                  .cuts = {},
                  .junctions = {}};
  CutOutline outline{.name = "intersection", .outer = {}, .inner = {}, .torch = {}};
  for (const auto& profile : cut.profiles) {
    (profile.outer ? outline.outer : outline.inner) = profile_curve(profile);
    if (profile.outer)
      for (const auto& event : profile.events) out.junctions.push_back(event.phi);
  }
  out.cuts.push_back(std::move(outline));
  return out;
}

Development developed(const bevel::HoleSpec& spec, const bevel::HoleCut& cut) {
  Development out{.outer_radius = spec.chord.outer_radius,
                  .wall = spec.chord.wall,
                  .cuts = {},
                  .junctions = {}};
  for (const auto& hole : cut.holes)
    out.cuts.push_back(outline(spec.chord, hole, hole.far ? "far hole" : "hole"));
  return out;
}

CutOutline outline(const joint::Target& chord, const bevel::Hole& hole, std::string name) {
  const double outer = chord.outer_radius, inner = chord.inner_radius();
  return {.name = std::move(name),
          .outer = {.radius = outer, .phi = hole.phi, .z = hole.z},
          .inner = {.radius = inner, .phi = hole.phi_inner, .z = hole.z_inner},
          .torch = {.radius = outer, .phi = hole.torch_phi, .z = hole.torch_z},
          .around = false};
}

Development developed(const part::PartSpec& spec, const part::Part& part) {
  Development out{.outer_radius = spec.target.outer_radius,
                  .wall = spec.target.wall,
                  .cuts = {},
                  .junctions = {}};
  for (const auto* end : {&part.start, &part.finish}) {
    auto one = developed(end->spec, end->table);
    one.cuts.front().name = end == &part.start ? "start" : "finish";
    out.cuts.push_back(std::move(one.cuts.front()));
  }
  for (std::size_t i = 0; i < part.holes.size(); ++i)
    out.cuts.push_back(outline(spec.target, part.holes[i].hole, "hole " + std::to_string(i)));
  return out;
}

bool Development::around() const {
  return std::ranges::any_of(cuts, [](const CutOutline& cut) { return cut.around; });
}

Extent extent(const Development& development) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent e{kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (const auto& cut : development.cuts)
    for (const auto* curve : {&cut.outer, &cut.inner, &cut.torch})
      for (std::size_t i = 0; i < curve->phi.size(); ++i) {
        e.phi_from = std::min(e.phi_from, curve->phi[i]);
        e.phi_to = std::max(e.phi_to, curve->phi[i]);
        e.z_from = std::min(e.z_from, curve->z[i]);
        e.z_to = std::max(e.z_to, curve->z[i]);
      }
  return e;
}

}  // namespace tubecut::api
