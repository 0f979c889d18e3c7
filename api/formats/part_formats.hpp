#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/wire/columns.hpp"
#include "api/wire/format.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// Both ends and the holes in the part's frame, one row a point, in the order they are cut; then
/// the check dimensions, in columns of their own.
[[nodiscard]] std::string part_csv(const part::PartSpec& spec, const part::Part& part,
                                   const Caption& caption);

/// Its work order (work_order.hpp), on sheets; view `template`: wrap_template.hpp.
[[nodiscard]] std::string part_svg(const part::PartSpec& spec, const part::Part& part,
                                   const Caption& caption);
[[nodiscard]] std::string part_pdf(const part::PartSpec& spec, const part::Part& part,
                                   const Caption& caption);

/// The whole part as drawing and machine files: dxf.hpp, dstv.hpp, gcode.hpp.
[[nodiscard]] std::string part_dxf(const part::PartSpec& spec, const part::Part& part,
                                   const Caption& caption);
[[nodiscard]] std::string part_dstv(const part::PartSpec& spec, const part::Part& part,
                                    const Caption& caption);
[[nodiscard]] std::string part_gcode(const part::PartSpec& spec, const part::Part& part,
                                     const Caption& caption);

/// Of every tube's part: the check dimensions, the title of its sheets, and the options
/// that only a template takes.
[[nodiscard]] Columns dimension_columns(const std::vector<part::CheckDimension>& dimensions);
[[nodiscard]] std::string_view title_of_part(const Caption& caption);
void refuse_options_of_template(const Caption& caption);

}  // namespace tubecut::api
