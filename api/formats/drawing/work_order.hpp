#pragma once

#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/wire/format.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// The part on sheets of A4 for those who cut and check it: what it is and whether to cut it; a
/// view in space; its outside developed, true to shape, with both ends, holes and marks; where each
/// hole is and how large, with room for what was measured; the check dimensions, and the mistakes
/// that change them; the steps in their order; what is accepted; who made and checked it.
[[nodiscard]] std::vector<Canvas> work_order(const part::PartSpec& spec, const part::Part& part,
                                             const Caption& caption);

}  // namespace tubecut::api
