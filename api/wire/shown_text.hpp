#pragma once

#include <string_view>

namespace tubecut::api {

/// Returns whether a text in UTF-8 has a visible character, because two texts of only blanks of any
/// script, joiners, fillers or variation marks look alike.
[[nodiscard]] bool shows_something(std::string_view text);

}  // namespace tubecut::api
