#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
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

/// Returns true if a request for a bevel table, also one within another, cuts a target or an end of
/// a node that is not round.
[[nodiscard]] bool cuts_section(const Reader& in);

/// A request for the bevel table of a target that is not round.
struct SectionCutRequest {
  BevelTableRequest table = {};
  SectionTarget section = {};
};
/// Reads all of it.
[[nodiscard]] SectionCutRequest decode_section_cut_request(Reader& in);

/// Refuses fields that a tube which is not round does not have.
void refuse_fields(Reader& in, std::initializer_list<const char*> fields, std::string_view hint);
/// Refuses values of a cut that apply only to round targets, each at its own pointer: other
/// dihedrals, hermite, root gaps of zones.
void refuse_round_only(Reader& in, const bevel::TableSpec& spec);

/// Write members of a table's `result`: events and mutations; where the torch's range binds, the
/// penetration and the torch line; the gaps of an untilted cut.
void encode_section_lists(const bevel::SectionTable& table, Writer& w);
void encode_section_proof(const bevel::SectionTable& table, Writer& w);
void encode_section_laser(const bevel::SectionTable& table, Writer& w);

/// Returns the values that `accept` limits.
[[nodiscard]] std::vector<Measure> measures_of(const bevel::TableSpec& spec,
                                               const bevel::SectionTable& table);

/// Writes the members of a table's `result`. Only the `columns` of its points are printed.
void encode_table(const bevel::TableSpec& spec, const bevel::SectionTable& table,
                  const std::vector<std::string>& columns, Writer& w);

}  // namespace tubecut::api
