#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/wire/format.hpp"

namespace tubecut::api {

/// Returns the text in letters, digits and . _ -; Latin letters spelled in ASCII, other characters
/// as _.
[[nodiscard]] std::string in_file_name(std::string_view text);

/// A program as a file.
struct ProgramFile {
  std::string media, ending;
  std::string name;  // from the post; empty if it sets no name
};
/// Returns the file of a document by a post; for other formats, as the format defines.
[[nodiscard]] ProgramFile program_file(
    const FormatName& format, const FormatOptions& options, std::string_view endpoint,
    const std::vector<std::pair<std::string, std::string>>& reference,
    std::string_view input_sha256);

}  // namespace tubecut::api
