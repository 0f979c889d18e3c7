#pragma once

#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/wire/format.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// The work order of a part that is not round: the order, its sizes and verdict, its four
/// faces as seen from outside with the lengths and angles that a fabricator measures, the steps,
/// the check dimensions and the fields to sign.
[[nodiscard]] std::vector<Canvas> section_work_order(const part::SectionPartSpec& spec,
                                                     const part::SectionPart& part,
                                                     const Caption& caption);

}  // namespace tubecut::api
