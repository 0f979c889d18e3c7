#pragma once

#include <string>
#include <vector>

#include "api/wire/format.hpp"
#include "core/bevel/table/table.hpp"

namespace tubecut::api {

/// How B counts, in the answer and in every file that names it.
[[nodiscard]] std::string_view name_of_b_sign(const bevel::Table& table);
/// For everything in a part's frame: its ends, its holes.
inline constexpr const char* kBSignInPart = "outer_edge_to_plus_z";

/// Returns whether the cut has a corner at each row: its junctions, if the sampling makes them
/// rows.
[[nodiscard]] std::vector<bool> corners(const bevel::TableSpec& spec, const bevel::Table& table);

/// The named columns of the table; no names: every one.
[[nodiscard]] std::string bevel_table_csv(const bevel::TableSpec& spec, const bevel::Table& table,
                                          const std::vector<std::string>& columns,
                                          const Caption& caption);

/// B before and after smoothing over the developed length, with the junctions, the mutations and
/// the segments in which the torch range binds; below it the finished edges over phi. The views
/// `template` and `section`: see wrap_template.hpp and sections.hpp; `b_curve`: B over phi with the
/// B that the groove requires, the B that clears the partners, the torch's limits, and the partner
/// of each segment.
[[nodiscard]] std::string bevel_table_svg(const bevel::TableSpec& spec, const bevel::Table& table,
                                          const Caption& caption);

/// The views `template` and `section` again, on pages.
[[nodiscard]] std::string bevel_table_pdf(const bevel::TableSpec& spec, const bevel::Table& table,
                                          const Caption& caption);

/// The developed cut; view `tube`: on the tube in space.
[[nodiscard]] std::string bevel_table_dxf(const bevel::TableSpec& spec, const bevel::Table& table,
                                          const Caption& caption);
/// The cut end as a solid: nodes `before` and `after` smoothing.
[[nodiscard]] std::string bevel_table_gltf(const bevel::TableSpec& spec, const bevel::Table& table,
                                           const Caption& caption);
/// The cut end as a solid, after smoothing (view `before`: before it).
[[nodiscard]] std::string bevel_table_stl(const bevel::TableSpec& spec, const bevel::Table& table,
                                          const Caption& caption);
[[nodiscard]] std::string bevel_table_dstv(const bevel::TableSpec& spec, const bevel::Table& table,
                                           const Caption& caption);
[[nodiscard]] std::string bevel_table_gcode(const bevel::TableSpec& spec, const bevel::Table& table,
                                            const Caption& caption);

}  // namespace tubecut::api
