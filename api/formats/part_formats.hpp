#pragma once

#include <string>

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

}  // namespace tubecut::api
