#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/bevel/kerf.hpp"
#include "core/bevel/table_parts.hpp"

namespace tubecut::bevel::detail {
namespace {

/// Height at which a cut of this slope just touches, at one node. A partner that is lost here at
/// its silhouette, all across the wall, does not hold the lower of the jump's two nodes.
double lift_at(const Ground& g, const Rows& rows, std::size_t i, double slope) {
  const auto& nodes = rows.samples.nodes;
  const auto line = joint::generator_at(g.wall.inner, nodes[i].phi);
  const bool first = rows.jump_pair(i);
  const auto pair = first ? i + 1 : i - 1;
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

void fill_surfaces(const Ground& g, const Rows& rows, Table& out) {
  const auto& nodes = rows.samples.nodes;
  const double t = g.spec.target.wall, f = g.spec.root_face;
  const auto drop = kerf_drops(g.root, rows.samples, out.b, out.gamma, g.spec.kerf);
  for (std::size_t i = 0; i < out.b.size(); ++i) {
    const double slope = (out.inward ? -1.0 : 1.0) * elementary::tan(out.b[i]);
    const bool outer = g.inner.has_value();
    const bool lifted = g.spec.contact == Contact::automatic;
    double z = nodes[i].z;  // of the root surface
    if (lifted) z = std::max(z, lift_at(g, rows, i, slope));
    double foot = outer ? z - t * slope : z;  // where the bevel's line meets the inner wall
    out.z_inner.push_back(foot);
    if (f > 0.0) {
      out.b_face.push_back(rows.points[i].face);
      out.z_face.push_back(z + f * elementary::tan(rows.points[i].face));
      foot = out.z_face[i] - f * slope;
    }
    out.z_outer.push_back(outer ? z : foot + t * slope);
    out.gap.push_back(outer    ? out.z_inner[i] - joint::contact_at(*g.inner, out.phi[i]).z
                      : lifted ? z - nodes[i].z
                               : 0.0);
    out.beam.push_back(t / elementary::cos(out.b[i]));
    out.torch_inner.push_back(foot - drop[i]);
    out.torch_outer.push_back(out.z_outer[i] - drop[i]);
  }
}

Result<void> check_clearance(const Ground& g, const Rows& rows, const Table& out) {
  if (g.spec.contact != Contact::outer) return {};
  constexpr double kEnters = 1e-9;  // of the radius
  std::vector<double> depth;
  for (std::size_t i = 0; i < out.b.size(); ++i)
    depth.push_back(lift_at(g, rows, i, elementary::tan(out.b[i])) - out.z_inner[i]);
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

std::vector<double> shortfalls(const Ground& g, const Table& t, double tolerance) {
  constexpr double kNarrow = 1e-4;  // mm, developed: no finer
  std::vector<double> out;
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const auto j = (i + 1) % t.phi.size();
    const double step = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
    const double along = g.wall.inner * step;
    if (along < kNarrow) continue;
    const double rise = t.z_inner[j] - t.z_inner[i];
    bool enters = false;
    for (const double u : {0.25, 0.5, 0.75}) {
      const double phi = t.phi[i] + u * step;
      const double low = t.z_inner[i] + u * rise;
      const double high = t.z_outer[i] + u * (t.z_outer[j] - t.z_outer[i]);
      const double needed = lift(g.root.cutters, g.wall, joint::generator_at(g.wall.inner, phi),
                                 (high - low) / g.spec.target.wall);
      enters = enters || (needed - low) * along > tolerance * elementary::hypot(along, rise);
    }
    for (const double u : {0.25, 0.5, 0.75})
      if (const double phi = t.phi[i] + u * step; enters)
        out.push_back(phi < kTwoPi ? phi : phi - kTwoPi);
  }
  return out;
}
}  // namespace tubecut::bevel::detail
