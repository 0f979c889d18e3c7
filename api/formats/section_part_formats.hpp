#pragma once

#include <string>

#include "api/wire/format.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

// The files of a part that is not round, as those of a round one (part_formats.hpp).

[[nodiscard]] std::string section_part_csv(const part::SectionPartSpec& spec,
                                           const part::SectionPart& part, const Caption& caption);
[[nodiscard]] std::string section_part_svg(const part::SectionPartSpec& spec,
                                           const part::SectionPart& part, const Caption& caption);
[[nodiscard]] std::string section_part_pdf(const part::SectionPartSpec& spec,
                                           const part::SectionPart& part, const Caption& caption);
[[nodiscard]] std::string section_part_dxf(const part::SectionPartSpec& spec,
                                           const part::SectionPart& part, const Caption& caption);
/// The finished part as a solid: see step/section_solid.hpp. Both views are the answer's own lines.
[[nodiscard]] std::string section_part_step(const part::SectionPartSpec& spec,
                                            const part::SectionPart& part, const Caption& caption);
/// dxf/section_dstv.hpp
[[nodiscard]] std::string section_part_dstv(const part::SectionPartSpec& spec,
                                            const part::SectionPart& part, const Caption& caption);
/// gcode/gcode.hpp
[[nodiscard]] std::string section_part_gcode(const part::SectionPartSpec& spec,
                                             const part::SectionPart& part, const Caption& caption);

}  // namespace tubecut::api
