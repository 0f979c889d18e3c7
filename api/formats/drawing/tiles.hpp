#pragma once

#include <string>
#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/formats/drawing/template_labels.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// Texts that every tile has about its template.
struct TileWords {
  std::string title;  // and the part
  std::vector<std::string> lines;
  double x = 0.0, z = 0.0;  // of the drawing's lower left corner on the developed surface
  bool mirrored = false;    // x counts from the right
};

/// Returns a drawing at full size on pages of the paper, upright or across, for the smaller number
/// of pages: each shows a window of it, with the overlap of the next page marked to glue on, crop
/// marks at its corners, a map of the pages, the shown range, and a 100 mm ruler in each direction.
/// Every page has the labels of its own window, whole. Pages without any of `cuts` are omitted. The
/// window of page k has the id `window-k`.
[[nodiscard]] std::vector<Canvas> tiles(const TemplateDrawing& drawing,
                                        const TemplateLabels& labels, Paper paper,
                                        const TileWords& words);

}  // namespace tubecut::api
