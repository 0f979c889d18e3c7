#pragma once

#include <vector>

#include "core/part/part.hpp"

namespace tubecut::part {

/// Returns the cut-outs of a part without holes, in the order of `opening_order`.
[[nodiscard]] std::vector<Step> cutout_order(const cutout::Layout& layout);

/// Holes and cut-outs from the free end towards the clamp. Cut-outs that end within 0.5 mm of the
/// same height are one row, cut on the way round from the last.
[[nodiscard]] std::vector<Step> opening_order(const Part& part);

/// Marks first, then the openings, then the free end, then the end that parts the piece from what
/// is clamped.
[[nodiscard]] std::vector<Step> sequence(const Part& part);

}  // namespace tubecut::part
