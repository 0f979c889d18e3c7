#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tubecut::api {

/// Removes and returns the first character of a text that is not empty; nothing if it is not UTF-8.
[[nodiscard]] std::optional<char32_t> take_character(std::string_view& text);

[[nodiscard]] bool is_utf8(std::string_view text);

/// One to `longest` characters in UTF-8, every one of which is seen: no control, no mark that only
/// turns or joins its neighbours, no separator of lines.
[[nodiscard]] bool is_visible(std::string_view text, std::size_t longest);

/// Returns valid UTF-8 spelled in printable ASCII: Latin letters without their marks (umlauts with
/// an e), signs by their names. Nothing if a letter has no such spelling.
[[nodiscard]] std::optional<std::string> in_ascii(std::string_view text);

/// Thrown if a printer meets a text that its format cannot spell. `run` answers it by bad_text.
struct Unspellable {
  std::string text;
};

}  // namespace tubecut::api
