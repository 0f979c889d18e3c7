#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/bevel/table/table.hpp"
#include "core/joint/section/section_contour.hpp"
#include "core/section/section.hpp"

namespace tubecut::bevel {

/// The bevel table of one cut end of a section, one entry per row, ascending girth; two rows at a
/// jump. Angles in rad, lengths in mm.
struct SectionTable {
  std::vector<section::Station> at;  // outside
  std::vector<double> wall;          // along the inward normal of the row
  std::vector<double> developed;     // abscissa of the smoothing
  std::vector<double> length;        // along the root
  std::vector<std::size_t> cutter;
  std::vector<double> z_inner, z_outer;  // the finished part
  std::vector<double> z_face, b_face;    // outer edge and elevation of the land; empty without one
  std::vector<std::size_t> zone;         // of the groove rule's table; empty without one
  std::vector<double> dihedral, groove, gamma, flush;
  std::vector<double> b_raw, b_required, b;
  std::vector<double> gap;   // root opening: z_inner less the envelope on the bore
  std::vector<double> beam;  // metal along the torch line
  std::vector<double> torch_inner, torch_outer;  // the torch axis, kerf applied
  std::vector<bool> corner;                      // an event other than a seam lies here
  GapMap gaps;                                   // of an untilted cut
  std::vector<joint::SectionEvent> inner_events, outer_events;  // each along its own outline
  struct Step {
    double s, step;
  };
  std::vector<Step> mutations;
  struct Binding {
    double from, to;     // s; one that crosses the datum ends above the girth
    double groove_lost;  // largest angle by which the bevel was cut back
    double root_gap;     // largest root opening there
  };
  std::vector<Binding> torch_binds;
  double length_total = 0.0, developed_total = 0.0, girth = 0.0;
  Multipliers multipliers;  // of the smoothing; empty unless refined
  struct Deepest {
    double depth = 0.0;                    // normal to the partner; 0 if none is entered
    double s = 0.0, below = 0.0, z = 0.0;  // below: from the outside, along the row's normal
    std::size_t solid = 0;
  };
  Deepest penetration;
  struct Torch {
    double gouge = 0.0, gouge_s = 0.0;  // depth that the beam cuts into the finished part
  };
  Torch torch_line;
  std::vector<Warning> warnings;
};

/// As `table` of a round target. Rows are places of the outside; the wall of each is crossed along
/// the inward normal there. Angles are those between the partner and the root's own surface, whose
/// normal on a bore that is not concentric differs from the row's; B is the elevation in the plane
/// of the row's normal and the axis. With a tolerance the seams of both outlines, all events, and
/// the places where B or the torch's line bends are rows.
///
/// `spec.target` gives the length alone. Hermite smoothing, dihedrals for comparison, and zones
/// with root gaps of their own are refused (unsupported_combination).
/// Errors    those of `table` except sampling_not_uniform and transition_too_long.
/// Accuracy  `penetration` is the deepest of 40 places of each gap between rows, refined along the
///           gap; `torch_line` the worst of 10 places of each gap. `verify` compares both with
///           other places, within 1e-3 and 5e-3 mm.
/// Cost      linear in the rows, with a kerf about 1 ms each.
/// Source    docs/theory/sections.md, sections 3 to 5.
[[nodiscard]] Result<SectionTable> section_table(const section::Section& section,
                                                 const TableSpec& spec);

/// Verifies the table from its own numbers by independent formulas: distances and normals of solids
/// in space, differences of the smoothed angle, the beam as a cylinder.
[[nodiscard]] std::vector<Check> verify(const section::Section& section, const TableSpec& spec,
                                        const SectionTable& table);

}  // namespace tubecut::bevel
