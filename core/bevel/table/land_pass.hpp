#pragma once

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// Computes the pass that makes the land of a root face, as a table of its own without a land: the
/// land's own line extended through the wall, with the torch line that a beam of the kerf's width
/// needs along it. The bevel of `table` is the pass behind it.
///
/// Frame   that of `table`, which must have a land and be in its own frame.
/// Errors  unsupported_combination (root_face): the land leans beyond the torch's range, or further
///         than the bevel, so that its pass would enter the finished part; out_of_range (kerf);
///         cancelled.
/// Source  docs/theory/intersections-and-bevels.md, sections 5.5 and 5.6.
[[nodiscard]] Result<Table> land_pass(const TableSpec& spec, const Table& table);

}  // namespace tubecut::bevel
