#pragma once

#include <span>
#include <string>
#include <vector>

#include "api/wire/columns.hpp"
#include "api/wire/writer.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/joint/section/section_intersection.hpp"

namespace tubecut::api {

// The tables of a target that is not round. A column added here appears in JSON, CBOR and CSV.

/// Returns the columns that name a place of an outline: girth_mm, normal_deg, face, on_corner.
[[nodiscard]] Columns station_columns(std::span<const section::Station> at);
/// Returns the points of one surface's profile.
[[nodiscard]] Columns profile_columns(const joint::SectionProfile& profile);

/// Returns the rows of a bevel table.
[[nodiscard]] Columns bevel_columns(const bevel::TableSpec& spec, const bevel::SectionTable& table);
/// Returns the names of the columns that such a table has.
[[nodiscard]] std::vector<std::string> section_bevel_column_names(const bevel::TableSpec& spec);

/// Returns the edge and the torch's axis of a cut-out on a flat; `radius` is that of the circle
/// that is as long as the girth. On the bore, both lie at the same places of the face.
[[nodiscard]] Columns flat_cutout_columns(const bevel::Hole& rows, const section::Section& section);
/// Returns the same of a cut-out over corners: also the place's own columns, the edge and the axis
/// on the bore, and the lean across.
[[nodiscard]] Columns corner_cutout_columns(const bevel::Hole& rows,
                                            const section::Section& section);

/// Returns the name of an event on the wire.
[[nodiscard]] std::string_view event_name(joint::SectionEventKind kind);
/// Writes one event as an object; `outer` names its surface.
void encode_event(const joint::SectionEvent& event, bool outer, Writer& w);
/// Writes the curve on one surface, as members of an object.
void encode_profile(const joint::SectionProfile& profile, Writer& w);

}  // namespace tubecut::api
