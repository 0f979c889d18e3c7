#pragma once

#include "core/bevel/section/section_rows.hpp"
#include "core/bevel/section/section_surface.hpp"

namespace tubecut::bevel::detail {

/// Returns the request for a flush bevel of the same end, lifted where the torch range binds,
/// without kerf.
[[nodiscard]] TableSpec flush_spec(const TableSpec& spec);

/// Returns the distances of both edges of a table from the nearest partner, at the rows of `rows`.
[[nodiscard]] EdgeGaps edge_gaps(const SectionSetup& g, const TableSpec& spec,
                                 const SectionTable& table, const SectionTable& rows);

/// Returns by how much the root opens at every row, along the axis. Where its edge lies on a
/// partner's metal it is closed, however far below the envelope is, as in a sliver between two
/// events.
[[nodiscard]] std::vector<double> root_openings(const SectionSetup& g,
                                                const SectionSurface& surface,
                                                const SectionTable& table);

/// Warns of places where the wall outside passes beside every partner by more than
/// joint::kSlightOverhang.
void note_overhang(const SectionSetup& g, SectionTable& out);

}  // namespace tubecut::bevel::detail
