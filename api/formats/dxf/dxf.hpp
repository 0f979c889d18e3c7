#pragma once

#include <string>

#include "api/formats/drawing/development.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// The cut as DXF R2000 in millimetres on the layers CUT_OUTER, CUT_INNER, TORCH,
/// SEAM, DATUM, TEXT and MARK.
///
/// As developed (the default) each wall lies on its own surface, x = its radius * phi, y = z, so
/// that lengths are the wall's own: a hole is a closed polyline; a cut round the tube begins and
/// ends on the seams at the same z, and closes with SEAM and DATUM to an outline with common
/// corners. View `tube`: the same curves in space, closed, each point on the wall; z along the
/// tube. Points are the result's nodes; on the tube further ones keep a chord within 0.01 mm of the
/// wall.
///
/// Own writer: dxflib is GPL-2.0 and writes to named files only.
[[nodiscard]] std::string print_dxf(const Development& development, const Caption& caption);

/// Returns a whole part, both ends, holes and marks, in the part's frame: the same layers and
/// views, and MARK for the marks on the outside. In the developed view the SEAMs run from the
/// start's edge to the finish's, so that the outline closes; DATUM is z = 0. A hole across the seam
/// is drawn in one piece, beyond it.
[[nodiscard]] std::string print_dxf(const Development& development,
                                    const std::vector<part::Mark>& marks, const Caption& caption);

}  // namespace tubecut::api
