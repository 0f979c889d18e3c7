#pragma once

#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/bevel/table/radius_rates.hpp"
#include "core/bevel/table/required.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/solid.hpp"

/// The parts of `table`, for its own sources only: what stands fixed, the rows before smoothing,
/// the smoothing, the surfaces, and what is noted about them.
namespace tubecut::bevel::detail {

inline constexpr double kBelow = 1e-9 * kRadPerDeg;  // what counts as falling below, rad

/// What is needed at every node, computed once.
struct TableSetup {
  const TableSpec& spec;
  std::vector<joint::Cutter> cutters;
  joint::Contour root;
  std::optional<joint::Contour> inner;  // when the root is on the outer surface
  joint::Division other;                // of the wall that the root is not on
  std::vector<double> row_phases;    // of events off the root's surface: the other wall, the land
  std::vector<joint::Solid> solids;  // the partners, grown
  Wall wall;
  Rule rule;
  Rule flush;                 // where the target is set into its partner
  std::optional<Zones> gaps;  // where each zone has a root gap of its own: of the one partner

  [[nodiscard]] const joint::Contour& inner_contour() const { return inner ? *inner : root; }
};
[[nodiscard]] Result<TableSetup> set_up(const TableSpec& spec, const std::stop_token& stop);

/// The same end with a flush bevel, for comparison: root on the inner wall, lifted where the torch
/// ends, no kerf.
[[nodiscard]] TableSpec flush_of(const TableSpec& spec);
/// Distances of both edges to the partners, of this table and of the flush one.
[[nodiscard]] GapMap gap_map(const TableSetup& g, const Table& cut, const Table& flush,
                             const std::stop_token& stop);

/// One side of one node before smoothing. Angles in rad.
struct Point {
  std::size_t cutter = 0;
  Angles angles;
  RadiusRates rates;
  double raw = 0.0;       // rule within the torch range
  double required = 0.0;  // least B with which no partner enters the wall
  double input = 0.0;     // of the smoother
  double face = 0.0;      // elevation of the land
  double more = 0.0;      // by which the zone's root gap exceeds the least, mm
  double raised = 0.0;    // z of the root over that of the least gap, mm
};
[[nodiscard]] Point point(const TableSetup& g, double phi, const joint::Hit& hit,
                          std::size_t cutter, double root_z);

/// The rows of a table before smoothing: a point of each node.
struct Rows {
  joint::Samples samples;
  std::vector<Point> points;

  /// Is node i the first of a jump's two?
  [[nodiscard]] bool jump_pair(std::size_t i) const;
};
/// Rows at the phases `also` besides those of the sampling; what `known` has of them is taken over.
///
/// Errors  too_many_nodes, cancelled.
[[nodiscard]] Result<Rows> rows(const TableSetup& g, const std::vector<double>& also,
                                const Rows& known, const std::stop_token& stop);

/// The zones of a groove that have root gaps of their own; nullptr where there are none.
[[nodiscard]] const ZonedGroove* zones_with_gaps(const TableSpec& spec);
/// Zones that name the root gap go with one partner, the root inside, and no other gap.
[[nodiscard]] Result<void> check_gaps(const TableSpec& spec);
/// Where the root lies whose gap is its zone's at the dihedral there; `least`: with the least gap.
struct Stood {
  double more = 0.0;  // mm, beyond the least gap
  joint::PreparedCutter partner;
  joint::Hit hit;
};
[[nodiscard]] Stood stood_at(const TableSetup& g, const joint::Generator& line,
                             const joint::Hit& least);
/// Lengths along the raised root, straight between some places of each gap between rows.
void measure_root(const TableSetup& g, Rows& rows);
/// The partner grown for a root gap by so much more than the least.
[[nodiscard]] joint::PreparedCutter grown_for(const TableSetup& g, double more);
/// Phases of rows wanted where the root, straight between the rows, leaves its zones' gaps by more
/// than the tolerance. None where zones have no gaps of their own, or with uniform rows alone.
[[nodiscard]] std::vector<double> rows_where_gap_turns(const TableSetup& g, const Rows& rows);

/// Runs of nodes (cyclic) that satisfy `holds`, as phi intervals; one that crosses 0 ends above 2
/// pi.
template <class F>
[[nodiscard]] std::vector<std::pair<double, double>> runs(const std::vector<joint::Node>& nodes,
                                                          F holds) {
  std::vector<std::pair<double, double>> out;
  bool inside = false;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!holds(i)) {
      inside = false;
      continue;
    }
    if (!inside) out.emplace_back(nodes[i].phi, nodes[i].phi);
    out.back().second = nodes[i].phi;
    inside = true;
  }
  if (out.size() > 1 && holds(0) && holds(nodes.size() - 1)) {
    out.back().second = out.front().second + kTwoPi;
    out.erase(out.begin());
  }
  return out;
}
/// Radians to degrees.
[[nodiscard]] Intervals degrees(std::vector<std::pair<double, double>> intervals);

/// What its smoother has to keep.
[[nodiscard]] EnvelopeSpec envelope_of(const TableSpec& spec, const EnvelopeSmoothing& method);

/// Mutations, windows and B of the table.
///
/// Errors  those of the smoothing chosen.
[[nodiscard]] Result<void> fill_smoothed(const TableSetup& g, const Rows& rows, Table& out,
                                         const std::stop_token& stop);
/// B required beyond the torch: an error, with the root gap that lifting the cut would open.
[[nodiscard]] Result<void> check_required_in_torch_range(const TableSetup& g, const Rows& rows);
/// Phases of rows that a table smoothed by the envelope still lacks: a tolerance spares rows where
/// the contour is straight, but B may bend there, and a bend of the whole curvature A over a step
/// h turns the slope by A h at one row, which no axis follows. Empty when no row turns the slope
/// by more than a quarter of K (steps of K / 4A), and with uniform rows alone.
///
/// Source  docs/theory/intersections-and-bevels.md, section 6.2.
[[nodiscard]] std::vector<double> rows_where_b_turns(const TableSpec& spec, const Table& table);

/// Finished surface, root opening and metal in the beam.
void fill_surfaces(const TableSetup& g, const Rows& rows, Table& out, const std::stop_token& stop);
/// The torch's own line, so far below the rows, and what it takes and leaves.
void fill_torch(const TableSpec& spec, const std::vector<double>& drops, Table& out,
                const std::stop_token& stop);
/// Contact outer: does the cut stay clear of every partner across the wall?
[[nodiscard]] Result<void> check_clearance(const TableSetup& g, const Rows& rows, const Table& out,
                                           const std::stop_token& stop);
/// Phases of rows wanted in the gaps in which the finished wall may enter a partner by more than
/// `tolerance`: the contours of the walls do not tell where it curves.
[[nodiscard]] std::vector<double> entering_phases(const TableSetup& g, const Table& t,
                                                  double tolerance, const std::stop_token& stop);
/// How deep the finished wall enters a partner, and the warning where no mode promises that it does
/// not.
void state_penetration(const TableSetup& g, Table& out, const std::stop_token& stop);

/// Where the groove rule or the root gave way to the torch's range, and by how much.
void note_torch_binds(const TableSetup& g, const Rows& rows, Table& out);
/// Where the outer wall reaches beyond all partners' sides while the inner one does not.
void note_overhang(const TableSetup& g, Table& out);
void note_root_opens(const TableSpec& spec, Table& out);
/// On a bare grid events lie between nodes: by how much the straight line between them falls short.
void note_events_between(const TableSetup& g, Table& out);

}  // namespace tubecut::bevel::detail
