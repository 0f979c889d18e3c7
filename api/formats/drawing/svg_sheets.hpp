#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/formats/drawing/canvas.hpp"

namespace tubecut::api {

/// Sheets as one SVG at full size: width and height in mm, one unit of the viewBox a mm, the sheets
/// one below the other, each a group `sheet-1`, `sheet-2`, ... Coordinates to 0.001 mm.
[[nodiscard]] std::string print_svg(const std::vector<Canvas>& sheets, std::string_view title);

}  // namespace tubecut::api
