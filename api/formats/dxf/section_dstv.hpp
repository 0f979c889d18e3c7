#pragma once

#include <string>

#include "api/wire/format.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// A part that is not round as a DSTV NC file (.nc1): profile code M, rectangular tube.
///
/// Returns a file with one AK block for each face, on the sharp rectangle: x along the tube from
/// the start's long point, y from 0 to the side, corners not developed. Face 1 of the part is o,
/// face 2 v, face 3 u, face 4 h. On v and h, y counts from face 3 to face 1, and h is drawn as seen
/// through the tube from v; on o and u, y counts from face 4 to face 2. The outline is the outer
/// edge. A face whose cut has one bevel carries it; all bevels are in `**` lines.
[[nodiscard]] std::string print_dstv(const part::SectionPartSpec& spec,
                                     const part::SectionPart& part, const Caption& caption);

}  // namespace tubecut::api
