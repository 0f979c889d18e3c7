#pragma once

#include <string_view>

namespace tubecut::api {

/// Whether a text in UTF-8 has a character that is seen: blanks of any script and what only joins,
/// fills or varies its neighbours show nothing, so that two such texts look alike.
[[nodiscard]] bool shows_something(std::string_view text);

}  // namespace tubecut::api
