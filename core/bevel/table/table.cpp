#include "core/bevel/table/table.hpp"

#include <algorithm>
#include <functional>
#include <type_traits>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/beam/torch_line.hpp"
#include "core/bevel/table/table_parts.hpp"

namespace tubecut::bevel {
namespace {

using detail::Point;
using detail::Rows;
using detail::TableSetup;

template <class Entry, class F>
auto each(const std::vector<Entry>& entries, const F& value) {
  std::vector<std::decay_t<std::invoke_result_t<F, const Entry&>>> out;
  out.reserve(entries.size());
  for (const auto& entry : entries) out.push_back(std::invoke(value, entry));
  return out;
}

void fill_angles(const TableSetup& g, const Rows& rows, Table& out) {
  const auto& nodes = rows.samples.nodes;
  const auto& points = rows.points;
  const auto angle = [&](double Angles::*which) {
    return each(points, [=](const Point& p) { return p.angles.*which; });
  };
  out.phi = each(nodes, &joint::Node::phi);
  out.developed = each(nodes, [&](const joint::Node& n) { return g.root.radius * n.phi; });
  out.length = each(nodes, &joint::Node::length);
  out.cutter = each(points, &Point::cutter);
  out.dihedral = angle(&Angles::dihedral);
  out.groove = angle(&Angles::groove);
  out.tau = angle(&Angles::tau);
  out.gamma = angle(&Angles::gamma);
  out.flush = angle(&Angles::flush);
  out.dz_branch = each(points, [](const Point& p) { return p.rates.branch; });
  out.dz_chord = each(points, [](const Point& p) { return p.rates.chord; });
  out.b_raw = each(points, &Point::raw);
  out.b_required = each(points, &Point::required);
}

/// Finds the zone of every row; a dihedral outside the table is an error.
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

/// Returns the data that follow from the contours, before any row.
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

/// A table in progress.
struct Draft {
  std::vector<double> also = {};  // phases of rows in addition to those of the sampling
  Rows rows = {};
  Table table = {};
};

/// Adds rows, and computes B on all rows.
Result<void> smooth(const TableSetup& g, const std::vector<double>& more, Draft& draft) {
  draft.also.insert(draft.also.end(), more.begin(), more.end());
  TRY(draft.rows, detail::rows(g, draft.also, draft.rows));
  TRY(detail::check_required_in_torch_range(g, draft.rows));
  draft.table = outline(g, draft.rows);
  fill_angles(g, draft.rows, draft.table);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(fill_zones(g.spec, draft.rows, draft.table));
  return detail::fill_smoothed(g, draft.rows, draft.table);
}

/// Computes the finished surface on the draft's rows.
Result<void> surface(const TableSetup& g, Draft& draft) {
  detail::fill_surfaces(g, draft.rows, draft.table);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(detail::check_clearance(g, draft.rows, draft.table));
  for (const auto* z : {&draft.table.z_inner, &draft.table.z_outer})
    TRY(joint::check_length(g.spec.target, *z));
  return {};
}

Result<void> add(const TableSetup& g, const std::vector<double>& more, Draft& draft) {
  TRY(smooth(g, more, draft));
  return surface(g, draft);
}

/// Adds rows where the root goes from one zone's gap to another's.
Result<void> follow_gaps(const TableSetup& g, Draft& draft) {
  constexpr int kRounds = 12;  // of halving
  for (int round = 0; round < kRounds; ++round) {
    const auto more = detail::rows_where_gap_turns(g, draft.rows);
    if (more.empty()) break;
    TRY(smooth(g, more, draft));
  }
  return {};
}

/// Adds rows where B turns; only B determines them.
Result<void> follow_swing(const TableSetup& g, Draft& draft) {
  constexpr int kRounds = 6;  // of halving
  for (int round = 0; round < kRounds; ++round) {
    const auto more = detail::rows_where_b_turns(g.spec, draft.table);
    if (more.empty()) break;
    TRY(smooth(g, more, draft));
  }
  return {};
}

/// Adds rows where the torch's line bends; returns the line if it belongs to the draft. After the
/// first round it can bend anew only near the last added rows, because elsewhere only B moves, and
/// by little.
Result<std::optional<TorchLine>> follow_torch(const TableSetup& g, Draft& draft) {
  constexpr int kRounds = 3;  // the second covers the changes by the first's own rows
  auto line = torch_line(g.spec, draft.table);
  if (line.rows.empty()) return line;
  for (int round = 0; round < kRounds && !line.rows.empty(); ++round) {
    TRY(add(g, line.rows, draft));
    if (round + 1 == kRounds) break;
    line = torch_line(g.spec, draft.table, ways_near(g.spec, draft.table, line.rows));
  }
  return std::nullopt;
}

/// Adds rows where the finished wall enters a partner between rows; returns true if it added any.
Result<bool> follow_partners(const TableSetup& g, Draft& draft) {
  if (!promises_no_penetration(g.spec)) return false;
  constexpr int kRounds = 10;  // each divides a depth by sixteen if the cut is smooth
  for (int round = 0; round < kRounds; ++round) {
    const auto more = detail::entering_phases(g, draft.table, g.spec.sampling.tolerance->value);
    if (more.empty()) return round > 0;
    TRY(add(g, more, draft));
  }
  return true;
}

void note(const TableSetup& g, Draft& draft) {
  detail::note_torch_binds(g, draft.rows, draft.table);
  detail::note_overhang(g, draft.table);
  detail::note_root_opens(g.spec, draft.table);
  if (!g.spec.sampling.tolerance) detail::note_events_between(g, draft.table);
}

/// Computes the gaps of an untilted cut, and those of a bevelled cut with the same rows for
/// comparison.
Result<void> map_gaps(const TableSetup& g, Table& out) {
  const auto bevelled = detail::flush_of(g.spec);
  TRY(const auto other, detail::set_up(bevelled));
  Draft flush;
  TRY(add(other, out.phi, flush));
  out.gaps = detail::gap_map(g, out, flush.table);
  return {};
}

}  // namespace

Result<Table> table(const TableSpec& spec) {
  TRY(const auto g, detail::set_up(spec));
  Draft draft;
  TRY(smooth(g, g.row_phases, draft));
  TRY(follow_gaps(g, draft));
  TRY(follow_swing(g, draft));
  TRY(surface(g, draft));
  TRY(auto line, follow_torch(g, draft));
  TRY(const bool added, follow_partners(g, draft));
  note(g, draft);
  auto& out = draft.table;
  detail::state_penetration(g, out);
  if (spec.untilted) TRY(map_gaps(g, out));
  if (!line || added) line = torch_line(spec, out);
  detail::fill_torch(spec, line->drops, out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(check_spared(beam_cut(spec, out), out.torch_line));
  return std::move(out);
}

}  // namespace tubecut::bevel
