#pragma once

#include <string>
#include <vector>

#include "api/wire/columns.hpp"
#include "api/wire/writer.hpp"
#include "core/bevel/section/section_table.hpp"

namespace tubecut::api {

/// Returns the rows of a section's bevel table.
[[nodiscard]] Columns bevel_columns(const bevel::TableSpec& spec, const bevel::SectionTable& table);
/// Returns the names of the columns that such a table has.
[[nodiscard]] std::vector<std::string> section_column_names(const bevel::TableSpec& spec);

/// Writes the members of a table's `result`.
void encode_table(const bevel::TableSpec& spec, const bevel::SectionTable& table, Writer& w);

}  // namespace tubecut::api
