#pragma once

#include <vector>

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// The root gap asked for at each row, by its zone; empty where zones have none of their own.
///
/// Where they have, each row of a table is that of another table whose root gap is this one all
/// round, its zone's at its own dihedral; `gap` opens beyond it. With a tolerance there are rows
/// enough for the root to run straight between them within it. Such an end has one partner, its
/// root inside and contact inner or automatic; `Table::penetration` is told of the partner grown by
/// the least of the gaps.
[[nodiscard]] std::vector<double> root_gaps(const TableSpec& spec, const Table& table);

}  // namespace tubecut::bevel
