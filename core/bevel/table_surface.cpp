#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/bevel/table_parts.hpp"
#include "core/joint/stations.hpp"

namespace tubecut::bevel::detail {
namespace {

/// Height at which a cut of this slope just touches, at one node. A partner that is lost here at
/// its silhouette, all across the wall, does not hold the lower of the jump's two nodes.
double lift_at(const TableSetup& g, const Rows& rows, std::size_t i, double slope) {
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

void fill_surfaces(const TableSetup& g, const Rows& rows, Table& out, const std::stop_token& stop) {
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
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
    const double slope = (out.inward ? -1.0 : 1.0) * slopes[i];
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
    out.gap.push_back(outer ? out.z_inner[i] - envelope[i] : lifted ? z - nodes[i].z : 0.0);
    out.beam.push_back(t / cosines[i]);
  }
}

void lay_torch(const TableSpec& spec, const std::vector<double>& drops, Table& out,
               const std::stop_token& stop) {
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
  out.torch_line = clear_torch(n, lowered, stop);
}

Result<void> check_clearance(const TableSetup& g, const Rows& rows, const Table& out,
                             const std::stop_token& stop) {
  if (g.spec.contact != Contact::outer) return {};
  constexpr double kEnters = 1e-9;  // of the radius
  std::vector<double> depth;
  for (std::size_t i = 0; i < out.b.size() && !stop.stop_requested(); ++i)
    depth.push_back(lift_at(g, rows, i, elementary::tan(out.b[i])) - out.z_inner[i]);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
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

}  // namespace tubecut::bevel::detail
