#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/wire/columns.hpp"
#include "api/wire/format.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// The texts' strokes, the holes and both ends in the part's frame, one row a point, in the order
/// they are made; then the check dimensions, in columns of their own.
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
using NamedColumns = std::vector<std::pair<std::string, Columns>>;
/// Adds the strokes of a text, each as a table of its own.
void add_strokes(const cutout::Lettering& text, NamedColumns& out);
[[nodiscard]] Columns dimension_columns(const std::vector<part::CheckDimension>& dimensions);
[[nodiscard]] std::string_view title_of_part(const Caption& caption);
void refuse_options_of_template(const Caption& caption);

}  // namespace tubecut::api
