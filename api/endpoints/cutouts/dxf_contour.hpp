#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/cutout/cutout.hpp"

namespace tubecut::api {

inline constexpr std::size_t kLongestDxf = 65'536;

/// Reads the one closed contour of a DXF text: LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE of its
/// entities, in mm or, by $INSUNITS, in inches. Ends that lie within 0.01 mm of each other are one.
///
/// Errors  contour_open (the nearest end is too far away), bad_choice (another entity or unit),
///         bad_text (no entities, or no DXF), out_of_range (several contours, more than 500
///         pieces); each without a member.
[[nodiscard]] Result<cutout::Contour> read_dxf_contour(std::string_view text);

}  // namespace tubecut::api
