#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "core/base/turns.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/node/node.hpp"

namespace tubecut::bevel {

/// The table of one end of a node, or why it has none.
struct EndTable {
  TableSpec spec;  // as asked for, with this end's target and partners
  std::optional<Table> table;
  std::optional<Issue> refused;
};

/// The tables of every end that is cut all round and not consumed, in the order of `nodes.ends`;
/// the others are empty. `asked` tells everything but target and partners. An end that cannot be
/// cut as asked does not spoil the others: it says why. Each table is a turn.
///
/// Errors  wrong_count, out_of_range (groove/zones: the table of zones itself), too_many_nodes (of
///         all ends together), cancelled.
[[nodiscard]] Result<std::vector<std::optional<EndTable>>> end_tables(
    const joint::NodeSpec& spec, const joint::Nodes& nodes, const TableSpec& asked,
    const std::stop_token& stop = {}, const Turns& turns = in_order);

}  // namespace tubecut::bevel
