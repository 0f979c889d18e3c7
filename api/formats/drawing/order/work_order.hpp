#pragma once

#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/wire/format.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// Returns the part on sheets of A4 for the people who cut and check it: name and verdict; a view
/// in space; its outside developed, true to shape, with both ends, holes and marks; position and
/// size of each hole, with room for measurements; the check dimensions, and the mistakes that
/// change them; the steps in their order; the accepted limits; who made and checked it.
[[nodiscard]] std::vector<Canvas> work_order(const part::PartSpec& spec, const part::Part& part,
                                             const Caption& caption);

}  // namespace tubecut::api
