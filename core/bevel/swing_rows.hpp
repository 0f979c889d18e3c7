#pragma once

#include <vector>

#include "core/bevel/table.hpp"

namespace tubecut::bevel {

/// Phases of rows that a table smoothed by the envelope still lacks: a tolerance spares rows where
/// the contour is straight, but B may bend there, and a bend of the whole curvature A over a step
/// h turns the slope by A h at one row, which no axis follows. Empty when no row turns the slope
/// by more than a quarter of K (steps of K / 4A), and with uniform rows alone.
///
/// Source  docs/theory/intersections-and-bevels.md, section 6.2.
[[nodiscard]] std::vector<double> swing_rows(const TableSpec& spec, const Table& table);

}  // namespace tubecut::bevel
