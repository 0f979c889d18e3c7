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

/// The curves over the girth of each surface, or their template (wrap_template.hpp).
[[nodiscard]] std::string section_svg(const section::Section& section,
                                      const joint::SectionIntersection& cut,
                                      const Caption& caption);
[[nodiscard]] std::string section_pdf(const section::Section& section,
                                      const joint::SectionIntersection& cut,
                                      const Caption& caption);
/// The developed curves; view `tube`: on the tube in space.
[[nodiscard]] std::string section_dxf(const section::Section& section,
                                      const joint::SectionIntersection& cut,
                                      const Caption& caption);

/// A target that is not round, with its table.
struct SectionCut {
  const section::Section& section;
  const bevel::TableSpec& spec;
  const bevel::SectionTable& table;
};
/// B and the edges over the girth, or the template.
[[nodiscard]] std::string section_bevel_svg(const SectionCut& cut, const Caption& caption);
[[nodiscard]] std::string section_bevel_pdf(const SectionCut& cut, const Caption& caption);
[[nodiscard]] std::string section_bevel_dxf(const SectionCut& cut, const Caption& caption);
/// The solid end (mesh/cut_solid.hpp).
[[nodiscard]] std::string section_bevel_stl(const SectionCut& cut, const Caption& caption);
[[nodiscard]] std::string section_bevel_gltf(const SectionCut& cut, const Caption& caption);

/// The torch's program around it (gcode/gcode.hpp).
[[nodiscard]] std::string section_bevel_gcode(const SectionCut& cut, const Caption& caption);

/// Throws UnfitOption if the view is `section`, because that shows a round wall.
void refuse_section_view(const Caption& caption);

/// Returns what a format throws if it prints round targets only; `offered` names the formats that
/// print a section.
[[nodiscard]] UnfitOption no_format_of_section(std::string_view offered);

}  // namespace tubecut::api
