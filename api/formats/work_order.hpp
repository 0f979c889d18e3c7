#pragma once

#include <string>

#include "api/format.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// The part on a sheet of A4 for those who cut and check it: its outside developed, as seen
/// from outside (z to the right, phi downwards), with both ends,
/// holes and marks, the check dimensions with room for what was measured and the mistakes that
/// change them, and the steps in their order.
[[nodiscard]] std::string work_order(const part::PartSpec& spec, const part::Part& part,
                                     const Caption& caption);

}  // namespace tubecut::api
