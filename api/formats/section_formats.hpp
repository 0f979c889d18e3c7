#pragma once

#include <string>
#include <string_view>

#include "api/wire/format.hpp"
#include "core/joint/section/section_intersection.hpp"

namespace tubecut::api {

/// Prints one row per point; the first column names the surface.
[[nodiscard]] std::string section_csv(const joint::SectionIntersection& cut,
                                      const Caption& caption);

/// Returns what a format throws if it prints round targets only; `offered` names the formats that
/// print a section.
[[nodiscard]] UnfitOption no_format_of_section(std::string_view offered);

}  // namespace tubecut::api
