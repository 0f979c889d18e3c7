#include "core/bevel/table.hpp"

#include <algorithm>

#include "core/bevel/swing_rows.hpp"
#include "core/bevel/table_parts.hpp"

namespace tubecut::bevel {
namespace {

using detail::Ground;
using detail::Rows;

void fill_angles(const Ground& g, const Rows& rows, Table& out) {
  for (std::size_t i = 0; i < rows.points.size(); ++i) {
    const auto& node = rows.samples.nodes[i];
    const auto& [cutter, angles, raw, required, input, face] = rows.points[i];
    out.phi.push_back(node.phi);
    out.developed.push_back(g.root.radius * node.phi);
    out.length.push_back(node.length);
    out.cutter.push_back(cutter);
    out.dihedral.push_back(angles.dihedral);
    out.groove.push_back(angles.groove);
    out.tau.push_back(angles.tau);
    out.gamma.push_back(angles.gamma);
    out.flush.push_back(angles.flush);
    out.b_raw.push_back(raw);
    out.b_required.push_back(required);
  }
}

/// The zone of every row; a dihedral the table does not have is an error.
Result<void> fill_zones(const TableSpec& spec, const Rows& rows, Table& out) {
  const auto* zoned = std::get_if<ZonedGroove>(&spec.groove);
  if (zoned == nullptr) return {};
  const Zones zones(*zoned);
  for (const double dihedral : out.dihedral) out.zone.push_back(zones.at(dihedral).zone);
  auto missing = detail::runs(rows.samples.nodes,
                              [&](std::size_t i) { return !zones.at(out.dihedral[i]).inside; });
  if (missing.empty()) return {};
  const auto [low, high] = std::ranges::minmax(out.dihedral);
  return fail({.code = ErrorCode::out_of_range,
               .member = "groove/zones",
               .got = detail::degrees(std::move(missing)),
               .unit = "deg",
               .hint = "no zone for the dihedral there; this joint has " + shown(low * kDegPerRad) +
                       " to " + shown(high * kDegPerRad) + " deg"});
}

/// What the contours tell, before any row.
Table outline(const Ground& g, const Rows& rows) {
  Table out;
  out.inward = g.spec.dihedral != Dihedral::weld_side;
  out.inner_events = g.inner_contour().events;
  out.outer_events = g.inner ? g.root.events : g.other_events;
  out.length_total = rows.samples.true_length;
  out.developed_total = rows.samples.developed_length;
  out.warnings = joint::partner_warnings(g.root);
  return out;
}

/// The table with rows at the phases `also` besides those of the sampling.
Result<Table> build(const Ground& g, const std::vector<double>& also, const std::stop_token& stop) {
  const auto sampled = detail::rows(g, also, stop);
  if (!sampled) return tl::unexpected(sampled.error());
  const auto& rows = *sampled;
  if (auto ok = detail::check_torch(g, rows); !ok) return tl::unexpected(ok.error());
  auto out = outline(g, rows);
  fill_angles(g, rows, out);
  if (auto ok = fill_zones(g.spec, rows, out); !ok) return tl::unexpected(ok.error());
  if (auto ok = detail::fill_smoothed(g, rows, out, stop); !ok) return tl::unexpected(ok.error());
  detail::fill_surfaces(g, rows, out);
  if (auto ok = detail::check_clearance(g, rows, out); !ok) return tl::unexpected(ok.error());
  for (const auto* z : {&out.z_inner, &out.z_outer})
    if (auto ok = joint::check_length(g.spec.target, *z); !ok) return tl::unexpected(ok.error());
  detail::note_torch_binds(g, rows, out);
  detail::note_root_opens(g.spec, out);
  if (!g.spec.sampling.tolerance) detail::note_events_between(g, out);
  return out;
}

}  // namespace

Result<Table> table(const TableSpec& spec, const std::stop_token& stop) {
  constexpr int kRounds = 6;  // each divides a shortfall by sixteen where the cut is smooth
  const auto grounded = detail::ground(spec);
  if (!grounded) return tl::unexpected(grounded.error());
  const auto& g = *grounded;
  std::vector<double> also;
  for (const auto& event : g.other_events) also.push_back(event.phi);
  auto out = build(g, also, stop);
  for (int round = 0; out && round < kRounds; ++round) {
    const auto more = swing_rows(spec, *out);
    if (more.empty()) break;
    also.insert(also.end(), more.begin(), more.end());
    out = build(g, also, stop);
  }
  const bool held = spec.contact == Contact::inner || spec.contact == Contact::automatic;
  if (!held || !spec.sampling.tolerance || spec.root_face > 0.0) return out;
  // On the inner wall the sampling itself uses the whole tolerance.
  const double share = spec.contact == Contact::inner ? 1.0 : 0.5;
  for (int round = 0; out && round < kRounds; ++round) {
    const auto more = detail::shortfalls(g, *out, share * spec.sampling.tolerance->value);
    if (more.empty()) break;
    also.insert(also.end(), more.begin(), more.end());
    out = build(g, also, stop);
  }
  return out;
}

}  // namespace tubecut::bevel
