#pragma once

#include <vector>

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// Returns the requested root gap at each row, by its zone; empty when zones have no gaps of their
/// own.
///
/// If they have, each row of a table is that of another table whose root gap is this one
/// everywhere, its zone's at its own dihedral; `gap` opens beyond it. With a tolerance there are
/// enough rows for the root to be straight between them within it. Such an end has one partner, its
/// root inside and contact inner or automatic; `Table::penetration` refers to the partner grown by
/// the smallest of the gaps.
[[nodiscard]] std::vector<double> root_gaps(const TableSpec& spec, const Table& table);

}  // namespace tubecut::bevel
