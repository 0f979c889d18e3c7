#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/bevel/table/radius_rates.hpp"
#include "core/bevel/table/required.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/solid.hpp"

/// The parts of `table`, for its own sources only: the constant data, the rows before smoothing,
/// the smoothing, the surfaces, and their warnings.
namespace tubecut::bevel::detail {

inline constexpr double kBelow =
    1e-9 * kRadPerDeg;  // a larger difference counts as falling below, rad

/// Data that every node needs, computed once.
struct TableSetup {
  const TableSpec& spec;
  std::vector<joint::Cutter> cutters;
  joint::Contour root;
  std::optional<joint::Contour> inner;  // if the root is on the outer surface
  joint::Division other;                // of the wall that the root is not on
  std::vector<double> row_phases;    // of events off the root's surface: the other wall, the land
  std::vector<joint::Solid> solids;  // the partners, grown
  Wall wall;
  Rule rule;
  Rule flush;                 // where the target is set into its partner
  std::optional<Zones> gaps;  // if each zone has a root gap of its own, to the only partner

  [[nodiscard]] const joint::Contour& inner_contour() const { return inner ? *inner : root; }
};
[[nodiscard]] Result<TableSetup> set_up(const TableSpec& spec);

/// Returns the same end, flush, for comparison: root inside, lifted where the torch ends, no kerf.
[[nodiscard]] TableSpec flush_of(const TableSpec& spec);
/// Computes the distances of both edges to the partners, of this table and of the flush one.
[[nodiscard]] GapMap gap_map(const TableSetup& g, const Table& cut, const Table& flush);

/// One side of one node before smoothing. Angles in rad.
struct Point {
  std::size_t cutter = 0;
  Angles angles;
  RadiusRates rates;
  double raw = 0.0;       // rule within the torch range
  double required = 0.0;  // smallest B with which no partner enters the wall
  double input = 0.0;     // of the smoother
  double face = 0.0;      // elevation of the land
  double more = 0.0;      // excess of the zone's root gap over the smallest, mm
  double raised = 0.0;    // z of the root above that of the smallest gap, mm
};
[[nodiscard]] Point point(const TableSetup& g, double phi, const joint::Hit& hit,
                          std::size_t cutter, double root_z);

/// The rows of a table before smoothing: one point per node.
struct Rows {
  joint::Samples samples;
  std::vector<Point> points;

  /// Returns true if node i is the first of a jump's two.
  [[nodiscard]] bool jump_pair(std::size_t i) const;
};
/// Computes rows at the sampling's phases and those of `also`; reuses the points in `known`.
///
/// Errors  too_many_nodes, cancelled.
[[nodiscard]] Result<Rows> rows(const TableSetup& g, const std::vector<double>& also,
                                const Rows& known);

/// Returns the zones of a groove that have root gaps of their own, else nullptr.
[[nodiscard]] const ZonedGroove* zones_with_gaps(const TableSpec& spec);
/// Zones with root gaps require a single partner, the root inside, and no other gap.
[[nodiscard]] Result<void> check_gaps(const TableSpec& spec);
/// The root at which the gap is that of its zone; `least`: with the smallest gap.
struct Stood {
  double more = 0.0;  // mm, beyond the smallest gap
  joint::PreparedCutter partner;
  joint::Hit hit;
};
[[nodiscard]] Stood stood_at(const TableSetup& g, const joint::Generator& line,
                             const joint::Hit& least);
/// Measures lengths along the raised root, straight between some points of each gap between rows.
void measure_root(const TableSetup& g, Rows& rows);
/// Returns the partner grown for a root gap that exceeds the smallest by `more`.
[[nodiscard]] joint::PreparedCutter grown_for(const TableSetup& g, double more);
/// Returns the phases of rows that are needed where the root, straight between the rows, deviates
/// from its zones' gaps by more than the tolerance. Empty without such gaps or a tolerance.
[[nodiscard]] std::vector<double> rows_where_gap_turns(const TableSetup& g, const Rows& rows);

/// Returns the cyclic runs of nodes that satisfy `holds`; if one crosses phi = 0, it ends above 2
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
/// Converts radians to degrees.
[[nodiscard]] Intervals degrees(std::vector<std::pair<double, double>> intervals);

/// Returns the limits for its smoother.
[[nodiscard]] EnvelopeSpec envelope_of(const TableSpec& spec, const EnvelopeSmoothing& method);

/// Fills mutations, windows and B of the table.
///
/// Errors  those of the chosen smoothing.
[[nodiscard]] Result<void> fill_smoothed(const TableSetup& g, const Rows& rows, Table& out);
/// If B is required beyond the torch, returns an error with the root gap that a lift would open.
[[nodiscard]] Result<void> check_required_in_torch_range(const TableSetup& g, const Rows& rows);
/// Returns the phases of rows that a table smoothed by the envelope still lacks. They are needed
/// because a tolerance omits rows where the contour is straight, but B may bend there, and a bend
/// of the whole curvature A over a step h turns the slope by A h at one row, which no axis follows.
/// Empty if no row turns the slope by more than a quarter of K (steps of K / 4A), and if there are
/// only uniform rows.
///
/// Source  docs/theory/intersections-and-bevels.md, section 6.2.
[[nodiscard]] std::vector<double> rows_where_b_turns(const TableSpec& spec, const Table& table);

/// Computes finished surface, root opening and metal in the beam.
void fill_surfaces(const TableSetup& g, const Rows& rows, Table& out);
/// Computes the torch's own line, at these drops below the rows, and its gouges and rests.
void fill_torch(const TableSpec& spec, const std::vector<double>& drops, Table& out);
/// For contact outer, checks that the cut is clear of every partner across the wall.
[[nodiscard]] Result<void> check_clearance(const TableSetup& g, const Rows& rows, const Table& out);
/// Returns the phases of rows that are needed in the gaps in which the finished wall may enter a
/// partner by more than `tolerance`, because the contours of the walls do not show where it curves.
[[nodiscard]] std::vector<double> entering_phases(const TableSetup& g, const Table& t,
                                                  double tolerance);
/// Computes the depth of the finished wall in partners; warns unless the mode limits it.
void state_penetration(const TableSetup& g, Table& out);

/// Reports where the groove rule or the root yielded to the torch's range, and by how much.
void note_torch_binds(const TableSetup& g, const Rows& rows, Table& out);
/// Reports where the outer wall extends beyond all partners' sides while the inner one does not.
void note_overhang(const TableSetup& g, Table& out);
void note_root_opens(const TableSpec& spec, Table& out);
/// Reports how much a bare grid, with events between its nodes, falls short of the curve.
void note_events_between(const TableSetup& g, Table& out);

}  // namespace tubecut::bevel::detail
