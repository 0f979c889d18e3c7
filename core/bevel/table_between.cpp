#include <algorithm>

#include "core/bevel/penetration.hpp"
#include "core/bevel/table_parts.hpp"

namespace tubecut::bevel {

CutWall finished_wall(const TableSpec& spec, const Table& t) {
  CutWall out{.edges = {{spec.target.inner_radius(), t.phi, t.z_inner}}, .turn = kTwoPi};
  if (!t.z_face.empty())
    out.edges.push_back({spec.target.inner_radius() + spec.root_face, t.phi, t.z_face});
  out.edges.push_back({spec.target.outer_radius, t.phi, t.z_outer});
  return out;
}

double penetration_limit(const TableSpec& spec) {
  return spec.sampling.tolerance ? spec.sampling.tolerance->value : joint::Tolerance{}.value;
}

bool promises_no_penetration(const TableSpec& spec) {
  return spec.contact != Contact::none && spec.sampling.tolerance.has_value();
}

namespace detail {

std::vector<double> entering_phases(const TableSetup& g, const Table& t, double tolerance,
                                    const std::stop_token& stop) {
  constexpr double kNarrow = 1e-4;  // mm, developed: no finer
  const auto gaps = entering(finished_wall(g.spec, t), g.solids, tolerance, stop);
  std::vector<double> out;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const auto j = (i + 1) % gaps.size();
    const double step = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
    if (!gaps[i] || g.wall.inner * step < kNarrow) continue;
    for (const double share : {0.25, 0.5, 0.75}) {
      const double phi = t.phi[i] + share * step;
      out.push_back(phi < kTwoPi ? phi : phi - kTwoPi);
    }
  }
  return out;
}

void state_penetration(const TableSetup& g, Table& out, const std::stop_token& stop) {
  constexpr double kSlack = 3e-4;  // mm
  out.penetration = deepest(finished_wall(g.spec, out), g.solids, kSlack, stop);
  out.penetration.depth = std::max(0.0, out.penetration.depth);
  const auto& p = out.penetration;
  if (promises_no_penetration(g.spec) || !(p.depth > penetration_limit(g.spec))) return;
  out.warnings.push_back({.code = WarningCode::enters_partner,
                          .member = "cutters/" + std::to_string(p.solid),
                          .detail = "cutter " + std::to_string(p.solid) + " by up to " +
                                    brief(p.depth) + " mm, at phi " + brief(p.phi * kDegPerRad) +
                                    " deg, radius " + brief(p.radius) + " mm, z " + brief(p.z) +
                                    " mm"});
}

}  // namespace detail
}  // namespace tubecut::bevel
