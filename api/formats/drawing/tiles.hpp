#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/formats/drawing/template_labels.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// What every tile says of the template it is of.
struct TileWords {
  std::string title;  // and the part
  std::vector<std::string> lines;
  double x = 0.0, z = 0.0;  // of the drawing's lower left corner on the developed surface
  bool mirrored = false;    // x counts from the right
};

/// A drawing at full size on pages of the paper, upright or across, whichever needs fewer: each
/// shows a window of it, with what the next page overlaps marked to glue on, crop marks at its
/// corners, a map of the pages, what the window shows, and a 100 mm ruler each way. Every page has
/// the labels of its own window, whole. Pages that nothing of `cuts` is on are left out. The window
/// of page k has the id `window-k`.
[[nodiscard]] std::vector<Canvas> tiles(const TemplateDrawing& drawing,
                                        const TemplateLabels& labels, Paper paper,
                                        const TileWords& words, const std::stop_token& stop);

}  // namespace tubecut::api
