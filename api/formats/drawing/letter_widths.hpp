#pragma once

#include <string_view>

namespace tubecut::api {

/// Width of a text in Helvetica, the font of every PDF reader, in font heights. Adobe's metrics of
/// the printable ASCII; of letters beyond it the width that most have.
[[nodiscard]] double helvetica_width(std::string_view text, bool bold);

}  // namespace tubecut::api
