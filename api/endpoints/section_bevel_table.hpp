#pragma once

#include <string>
#include <vector>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/section_target.hpp"
#include "api/verdict.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/bevel/section/section_table.hpp"

namespace tubecut::api {

/// Reads the rest of a /v1/bevel-tables request whose target is not round, after its preset.
/// Refuses, in addition to what is refused of a round target: dihedrals for comparison, hermite,
/// root gaps of zones, and the limit of tongues.
[[nodiscard]] SectionTarget decode_section_cut(Reader& in, BevelTableRequest& out);

/// Returns the values that `accept` limits.
[[nodiscard]] std::vector<Measure> measures_of(const bevel::TableSpec& spec,
                                               const bevel::SectionTable& table);

/// Writes the members of a table's `result`. Only the `columns` of its points are printed.
void encode_table(const bevel::TableSpec& spec, const bevel::SectionTable& table,
                  const std::vector<std::string>& columns, Writer& w);

}  // namespace tubecut::api
