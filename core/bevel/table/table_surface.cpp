#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/beam/penetration.hpp"
#include "core/bevel/table/root_opens.hpp"
#include "core/bevel/table/table_parts.hpp"
#include "core/joint/solid.hpp"
#include "core/joint/stations.hpp"
#include "core/math/mixed.hpp"

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
namespace {

constexpr int kAcrossOpen = 16;  // samples if nothing is met

/// Computes the height at which a cut of this slope just touches, at one node. If a partner is lost
/// here at its silhouette, all across the wall, it does not hold the lower of the jump's two nodes.
double lift_at(const TableSetup& g, const Rows& rows, std::size_t i, double slope) {
  const auto& nodes = rows.samples.nodes;
  const auto line = joint::generator_at(g.wall.inner, nodes[i].phi);
  const bool first = rows.jump_pair(i);
  const auto pair = first ? i + 1 : i - 1;
  if (g.gaps) {
    const auto partner = grown_for(g, rows.points[i].more);
    return lift({&partner, 1}, g.wall, line, slope);
  }
  const bool lower =
      nodes[i].kind == joint::NodeKind::jump && pair < nodes.size() && nodes[i].z < nodes[pair].z;
  if (!lower) return lift(g.root.cutters, g.wall, line, slope);
  constexpr double kBeside = 1e-9;  // rad
  const double beside = nodes[i].phi + (first ? -kBeside : kBeside);
  const auto& lost = g.root.cutters[first ? nodes[pair].after : nodes[pair].before];
  for (const double rho : {g.wall.inner, g.wall.outer})
    if (joint::upper_sheet(lost, joint::generator_at(rho, beside)))
      return lift(g.root.cutters, g.wall, line, slope);
  auto others = g.root.cutters;
  others.erase(others.begin() + (&lost - g.root.cutters.data()));
  return lift(others, g.wall, line, slope);
}

}  // namespace

void fill_surfaces(const TableSetup& g, const Rows& rows, Table& out) {
  const auto& nodes = rows.samples.nodes;
  const double t = g.spec.target.wall, f = g.spec.root_face;
  const bool outer = g.inner.has_value();
  const bool lifted = g.spec.contact == Contact::automatic;
  const auto n = out.b.size();
  std::vector<double> slopes(n), cosines(n), envelope;
  elementary::tan(out.b, slopes);
  elementary::cos(out.b, cosines);
  if (outer)
    envelope = joint::contacts_at(*g.inner, joint::stations_at(g.wall.inner, out.phi), out.phi).z;
  for (auto* column : {&out.z_inner, &out.z_outer, &out.gap, &out.beam}) column->reserve(n);
  for (std::size_t i = 0; i < n && !stopped(); ++i) {
    const double slope = (out.inward ? -1.0 : 1.0) * slopes[i];
    const double root = nodes[i].z + rows.points[i].raised;
    double z = root;  // of the root surface
    if (lifted) z = std::max(z, lift_at(g, rows, i, slope));
    double foot = outer ? z - t * slope : z;  // where the bevel's line meets the inner wall
    out.z_inner.push_back(foot);
    if (f > 0.0) {
      out.b_face.push_back(rows.points[i].face);
      out.z_face.push_back(z + f * elementary::tan(rows.points[i].face));
      foot = out.z_face[i] - f * slope;
    }
    out.z_outer.push_back(outer ? z : foot + t * slope);
    out.gap.push_back(outer ? out.z_inner[i] - envelope[i] : lifted ? z - root : 0.0);
    out.beam.push_back(t / cosines[i]);
  }
}

void fill_torch(const TableSpec& spec, const std::vector<double>& drops, Table& out) {
  const auto n = out.b.size();
  out.torch_inner.resize(n);
  out.torch_outer.resize(n);
  std::vector<double> slopes(n);
  elementary::tan(out.b, slopes);
  const auto lowered = [&](const Further& further) {
    for (std::size_t i = 0; i < n; ++i) {
      const double slope = (out.inward ? -1.0 : 1.0) * slopes[i];
      const double foot =
          out.z_face.empty() ? out.z_inner[i] : out.z_face[i] - spec.root_face * slope;
      const double by = drops[i] + further[i] * elementary::hypot(1.0, slope);
      out.torch_inner[i] = foot - by;
      out.torch_outer[i] = out.z_outer[i] - by;
    }
    return beam_cut(spec, out);
  };
  out.torch_line = clear_torch(n, lowered);
}

Result<void> check_clearance(const TableSetup& g, const Rows& rows, const Table& out) {
  if (g.spec.contact != Contact::outer) return {};
  constexpr double kEnters = 1e-9;  // of the radius
  std::vector<double> depth;
  for (std::size_t i = 0; i < out.b.size() && !stopped(); ++i)
    depth.push_back(lift_at(g, rows, i, elementary::tan(out.b[i])) - out.z_inner[i]);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  auto intervals =
      runs(rows.samples.nodes, [&](std::size_t i) { return depth[i] > kEnters * g.wall.outer; });
  if (intervals.empty()) return {};
  return fail({.code = ErrorCode::cut_enters,
               .member = "contact",
               .got = degrees(std::move(intervals)),
               .limit = 0.0,
               .unit = "deg",
               .hint = "by up to " + shown(*std::ranges::max_element(depth)) +
                       " mm along the axis; contact auto lifts the cut clear"});
}

std::vector<double> entering_phases(const TableSetup& g, const Table& t, double tolerance) {
  constexpr double kNarrow = 1e-4;  // mm, developed: minimum
  const auto gaps = entering(finished_wall(g.spec, t), g.solids, tolerance);
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

void state_penetration(const TableSetup& g, Table& out) {
  constexpr double kSlack = 3e-4;  // mm
  out.penetration = deepest(finished_wall(g.spec, out), g.solids, kSlack);
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

void note_overhang(const TableSetup& g, Table& out) {
  if (g.inner) return;  // if the root is outside, both walls are met on all sides
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
    if (!(worst > joint::kSlightOverhang)) continue;
    out.warnings.push_back({.code = WarningCode::wall_overhangs,
                            .member = "target",
                            .detail = "phi " + brief(from) + " to " + brief(to) +
                                      " deg, its outer surface passes up to " + brief(worst) +
                                      " mm outside every partner"});
  }
}

void note_root_opens(const TableSpec& spec, Table& out) {
  const auto place = [&](std::size_t i) {
    return "phi " + brief(out.phi[i] * kDegPerRad) + " deg";
  };
  if (auto opens = root_opens(spec, out.gap, place)) out.warnings.push_back(*std::move(opens));
}

void note_events_between(const TableSetup& g, Table& out) {
  const auto n = out.phi.size();
  const double step = kTwoPi / static_cast<double>(n);
  double worst = 0.0, at = 0.0;
  const auto see = [&](double phi, double input) {
    const auto i = std::min(n - 1, static_cast<std::size_t>(phi / step));
    const double t = phi / step - static_cast<double>(i);
    const double line = math::mixed(out.b[i], out.b[(i + 1) % n], t);
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

}  // namespace detail
}  // namespace tubecut::bevel
