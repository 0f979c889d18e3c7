#pragma once

#include "core/cutout/cutout.hpp"
#include "core/part/cutout_report.hpp"

namespace tubecut::part {

/// Returns where the cut-outs leave the least of the tube's section, `gross` mm^2 without them: at
/// 9 heights of each row of cut-outs, then by golden section between the best one's neighbours.
[[nodiscard]] NetSection least_section(double gross, const cutout::Layout& layout);

}  // namespace tubecut::part
