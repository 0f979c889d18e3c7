#pragma once

#include "core/bevel/section/section_rows.hpp"

namespace tubecut::bevel::detail {

/// Returns the request for a flush bevel of the same end, lifted where the torch range binds,
/// without kerf.
[[nodiscard]] TableSpec flush_spec(const TableSpec& spec);

/// Returns the distances of both edges of a table from the nearest partner, at the rows of `rows`.
[[nodiscard]] EdgeGaps edge_gaps(const SectionSetup& g, const TableSpec& spec,
                                 const SectionTable& table, const SectionTable& rows);

/// Warns of places where the wall outside passes beside every partner by more than
/// joint::kSlightOverhang.
void note_overhang(const SectionSetup& g, SectionTable& out);

}  // namespace tubecut::bevel::detail
