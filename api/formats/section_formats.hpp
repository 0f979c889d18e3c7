#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/wire/format.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/joint/section/section_intersection.hpp"

namespace tubecut::api {

/// Prints one row per point; the first column names the surface.
[[nodiscard]] std::string section_csv(const joint::SectionIntersection& cut,
                                      const Caption& caption);

/// Prints one row per point of a bevel table: the named columns; no names: all.
[[nodiscard]] std::string section_bevel_csv(const bevel::TableSpec& spec,
                                            const bevel::SectionTable& table,
                                            const std::vector<std::string>& columns,
                                            const Caption& caption);

/// Returns what a format throws if it prints round targets only; `offered` names the formats that
/// print a section.
[[nodiscard]] UnfitOption no_format_of_section(std::string_view offered);

}  // namespace tubecut::api
