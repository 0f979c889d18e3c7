#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bevel/table_parts.hpp"
#include "core/joint/solid.hpp"

namespace tubecut::bevel::detail {
namespace {

constexpr int kAcrossOpen = 16;  // places looked at where nothing is met

}  // namespace

void note_overhang(const TableSetup& g, Table& out) {
  if (g.inner) return;  // with the root outside, both walls are met all round
  for (const auto& [from, to] : g.other.open) {
    double worst = 0.0;
    for (int k = 0; k <= kAcrossOpen; ++k) {
      const auto line =
          joint::generator_at(1.0, (from + (to - from) * k / kAcrossOpen) * kRadPerDeg);
      double beside = std::numeric_limits<double>::infinity();
      for (const auto& cutter : g.cutters)
        beside = std::min(beside, joint::Solid(cutter).clearance(g.wall.outer * line.cos_phi,
                                                                 g.wall.outer * line.sin_phi));
      worst = std::max(worst, beside);
    }
    out.warnings.push_back({.code = WarningCode::wall_overhangs,
                            .member = "target",
                            .detail = "phi " + brief(from) + " to " + brief(to) +
                                      " deg, its outer surface passes up to " + brief(worst) +
                                      " mm beside every partner"});
  }
}

void note_root_opens(const TableSpec& spec, Table& out) {
  if (spec.contact != Contact::automatic && spec.contact != Contact::outer) return;
  constexpr double kOpen = 1e-3;  // mm
  const auto widest = std::ranges::max_element(out.gap);
  if (widest == out.gap.end() || *widest <= kOpen) return;
  const auto at = static_cast<std::size_t>(widest - out.gap.begin());
  out.warnings.push_back({.code = WarningCode::root_opens,
                          .member = "contact",
                          .detail = "by up to " + shown(*widest) + " mm, at phi " +
                                    shown(out.phi[at] * kDegPerRad) + " deg"});
}

void note_events_between(const TableSetup& g, Table& out) {
  const auto n = out.phi.size();
  const double step = kTwoPi / static_cast<double>(n);
  double worst = 0.0, at = 0.0;
  const auto see = [&](double phi, double input) {
    const auto i = std::min(n - 1, static_cast<std::size_t>(phi / step));
    const double t = phi / step - static_cast<double>(i);
    const double line = (1.0 - t) * out.b[i] + t * out.b[(i + 1) % n];
    if (input - line > worst) {
      worst = input - line;
      at = phi;
    }
  };
  for (const auto& event : g.root.events)
    for (const bool before : {true, false}) {
      const auto cutter = before ? event.from : event.to;
      const auto line = joint::generator_at(g.root.radius, event.phi);
      const auto side = before ? joint::Side::before : joint::Side::after;
      const auto hit = event.kind == joint::EventKind::kink
                           ? joint::hit_at_corner(g.root.cutters[cutter], line, side)
                           : joint::continued_hit(g.root.cutters[cutter], line);
      see(event.phi, point(g, event.phi, hit, cutter, before ? event.z_from : event.z_to).input);
    }
  for (const auto& event : g.other.events) {
    const auto contact = joint::contact_at(g.root, event.phi);
    const auto line = joint::generator_at(g.root.radius, event.phi);
    const auto hit = joint::continued_hit(g.root.cutters[contact.cutter], line);
    see(event.phi, point(g, event.phi, hit, contact.cutter, contact.z).input);
  }
  out.warnings.push_back({.code = WarningCode::events_between_nodes,
                          .member = "sampling/uniform_points",
                          .detail = "largest shortfall of B between nodes " +
                                    brief(worst * kDegPerRad) + " deg at phi " +
                                    brief(at * kDegPerRad) + " deg"});
}
}  // namespace tubecut::bevel::detail
