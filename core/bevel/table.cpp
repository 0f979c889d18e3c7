#include "core/bevel/table.hpp"

#include <algorithm>

#include "core/base/try.hpp"
#include "core/bevel/swing_rows.hpp"
#include "core/bevel/table_parts.hpp"
#include "core/bevel/torch_line.hpp"

namespace tubecut::bevel {
namespace {

using detail::Rows;
using detail::TableSetup;

void fill_angles(const TableSetup& g, const Rows& rows, Table& out) {
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
Table outline(const TableSetup& g, const Rows& rows) {
  Table out;
  out.inward = g.spec.dihedral != Dihedral::weld_side;
  out.inner_events = g.inner_contour().events;
  out.outer_events = g.inner ? g.root.events : g.other.events;
  out.length_total = rows.samples.true_length;
  out.developed_total = rows.samples.developed_length;
  out.warnings = joint::partner_warnings(g.root);
  if (out.inward)
    out.warnings.push_back({.code = WarningCode::comparison_only, .member = "dihedral"});
  return out;
}

/// The table with rows at the phases `also` besides those of the sampling.
Result<Table> build(const TableSetup& g, const std::vector<double>& also,
                    const std::stop_token& stop) {
  TRY(const auto sampled, detail::rows(g, also, stop));
  const auto& rows = sampled;
  TRY(detail::check_required_in_torch_range(g, rows));
  auto out = outline(g, rows);
  fill_angles(g, rows, out);
  TRY(fill_zones(g.spec, rows, out));
  TRY(detail::fill_smoothed(g, rows, out, stop));
  detail::fill_surfaces(g, rows, out, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  TRY(detail::check_clearance(g, rows, out, stop));
  for (const auto* z : {&out.z_inner, &out.z_outer}) TRY(joint::check_length(g.spec.target, *z));
  detail::note_torch_binds(g, rows, out);
  detail::note_overhang(g, out);
  detail::note_root_opens(g.spec, out);
  if (!g.spec.sampling.tolerance) detail::note_events_between(g, out);
  return out;
}

/// The gaps of an untilted cut, beside those of a bevelled one that has all its rows.
Result<void> map_gaps(const TableSetup& g, Table& out, const std::stop_token& stop) {
  const auto bevelled = detail::flush_of(g.spec);
  TRY(const auto other, detail::set_up(bevelled, stop));
  TRY(const auto flush, build(other, out.phi, stop));
  out.gaps = detail::gap_map(g, out, flush, stop);
  return {};
}

}  // namespace

Result<Table> table(const TableSpec& spec, const std::stop_token& stop) {
  constexpr int kSwingRounds = 6;   // of halving
  constexpr int kTorchRounds = 3;   // the second sees what the first's own rows changed
  constexpr int kClearRounds = 10;  // each divides a depth by sixteen where the cut is smooth
  TRY(const auto g, detail::set_up(spec, stop));
  auto also = g.row_phases;
  auto out = build(g, also, stop);
  const auto with_rows = [&](const std::vector<double>& more) {
    also.insert(also.end(), more.begin(), more.end());
    out = build(g, also, stop);
    return out && !more.empty();
  };
  for (int round = 0; out && round < kSwingRounds; ++round) {
    const auto more = swing_rows(spec, *out);
    if (more.empty() || !with_rows(more)) break;
  }
  std::optional<TorchLine> line;  // of the table as it stands
  for (int round = 0; out && round < kTorchRounds; ++round) {
    line = torch_line(spec, *out, stop);
    if (line->rows.empty()) break;
    const auto more = std::move(line->rows);
    line.reset();
    if (!with_rows(more)) break;
  }
  if (spec.contact != Contact::none && spec.sampling.tolerance)
    for (int round = 0; out && round < kClearRounds; ++round) {
      const auto more = detail::entering_phases(g, *out, spec.sampling.tolerance->value, stop);
      if (more.empty()) break;
      line.reset();
      if (!with_rows(more)) break;
    }
  if (!out) return out;
  detail::state_penetration(g, *out, stop);
  if (spec.untilted) TRY(map_gaps(g, *out, stop));
  if (!line) line = torch_line(spec, *out, stop);
  detail::lay_torch(spec, line->drops, *out, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  if (auto ok = check_spared(beam_cut(spec, *out), out->torch_line); !ok)
    return tl::unexpected(ok.error());
  return out;
}

}  // namespace tubecut::bevel
