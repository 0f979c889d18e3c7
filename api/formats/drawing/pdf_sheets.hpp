#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/formats/drawing/canvas.hpp"

namespace tubecut::api {

/// Sheets as the pages of one PDF 1.4 at full size, in the fonts that every reader has, Helvetica
/// and Helvetica-Bold. No date, no compression: the same drawing gives the same bytes. Throws
/// Unspellable if a text has letters that neither they nor ASCII can spell.
[[nodiscard]] std::string print_pdf(const std::vector<Canvas>& sheets, std::string_view title);

}  // namespace tubecut::api
