#pragma once

#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table_columns.hpp"

namespace tubecut::bevel {

/// Calls `see(kind, column...)` with every numeric column of a section's table, as `each_column` of
/// a round tube's. Stations along the cut are not among them.
template <class F, class... T>
void each_section_column(const F& see, T&... t) {
  see(ColumnKind::plain, t.wall...);
  each_common_column(see, t...);
}

}  // namespace tubecut::bevel
