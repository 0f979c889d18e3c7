#pragma once

#include <string_view>

#include "api/formats/drawing/canvas.hpp"

namespace tubecut::api {

/// Draws a text as a DataMatrix (ECC 200) into a square of paper, with a quiet zone of one module
/// to all sides; nothing if the text is longer than a symbol holds. `low` is its lower left corner;
/// mm.
/// Source  ISO/IEC 16022, by libzint.
void draw_matrix_code(Canvas& canvas, DrawingPoint low, double side, std::string_view text);

}  // namespace tubecut::api
