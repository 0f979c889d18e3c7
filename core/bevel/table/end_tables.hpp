#pragma once

#include <optional>
#include <vector>

#include "core/base/parallel_for.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/node/node.hpp"

namespace tubecut::bevel {

/// The table of one end of a node, or the reason why it has no table.
struct EndTable {
  TableSpec spec;  // as requested, with this end's target and partners
  std::optional<Table> table;
  std::optional<Issue> refused;
  std::optional<section::Section> section = {};  // of a member that is not round
  std::optional<SectionTable> of_section = {};   // its table, in place of `table`
};

/// Computes the tables of every end that is cut on all sides and not consumed, in the order of
/// `nodes.ends`; the others are empty. `asked` specifies everything except target and partners. If
/// an end cannot be cut as requested, it returns its error and does not affect the others. Each
/// table is a task.
///
/// Errors  wrong_count, out_of_range (groove/zones: the table of zones itself), too_many_nodes (of
///         all ends together), cancelled.
[[nodiscard]] Result<std::vector<std::optional<EndTable>>> end_tables(
    const joint::NodeSpec& spec, const joint::Nodes& nodes, const TableSpec& asked,
    const ParallelFor& parallel_for = run_in_order);

}  // namespace tubecut::bevel
