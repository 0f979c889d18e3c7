#pragma once

#include "core/bevel/hole/hole.hpp"
#include "core/cutout/laying.hpp"

namespace tubecut::cutout {

/// How a chain is cut.
struct Cutting {
  double kerf = 0.0;        // mm
  double tolerance = 0.01;  // mm, of the straight ways from row to row on both developed walls
  bool as_cut = false;      // hollow corners tighter than the kerf are left as the beam leaves them
};

/// Returns the least radius of a hollow that the beam can follow, where the chain reaches `b` to
/// one side of its anchor.
[[nodiscard]] double least_radius(const Laying& laying, double kerf, double b);

/// Computes the edges on both walls and the torch's axis, row by row. Phases and heights count from
/// the anchor; `branch_phi` and what a branch would fit is empty.
///
/// The axis runs off the edge so that a round beam of the kerf's width takes nothing of the part:
/// of a prism and on a flat half a kerf in the local plane; square to a curved wall further,
/// because the beam takes more of the bore than of the outside.
///
/// Errors  out_of_range (pieces/i: a hollow tighter than the kerf, and `as_cut` is false; empty:
///         the chain is narrower than the kerf somewhere).
/// Source  docs/theory/cutouts.md, section 4.
[[nodiscard]] Result<bevel::Hole> rows(const Laying& laying, const Chain& chain,
                                       const Cutting& cutting);

/// The same of a slit: `chain` is what the beam takes, and the axis runs on its line, which lies
/// level with each place of the edge.
struct SlitLine;
[[nodiscard]] Result<bevel::Hole> slit_rows(const Laying& laying, const Chain& chain,
                                            const SlitLine& line, const Cutting& cutting);

/// The same of a mould, which may be a cone; that one has no errors.
struct Mould;
[[nodiscard]] Result<bevel::Hole> rows(const Mould& mould, const Cutting& cutting);

/// Sets the ways along the outer edge, whose circle or girth has the radius `outer`.
void measure_edge(double outer, bevel::Hole& rows);

/// From the edge to the torch's axis where the edge's unit normal towards the part is `normal`, in
/// the plane that the chain is offset in: a prism's local plane, else the developed outside.
[[nodiscard]] Flat kerf_offset(const Laying& laying, double kerf, const Flat& normal);

}  // namespace tubecut::cutout
