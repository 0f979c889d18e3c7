#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/wire/format.hpp"

namespace tubecut::api {

/// Letters, digits and . _ -; of what else there is, Latin letters by their spelling in ASCII, the
/// rest as _.
[[nodiscard]] std::string in_file_name(std::string_view text);

/// A program as a file.
struct ProgramFile {
  std::string media, ending;
  std::string name;  // by the post; empty where it says none
};
/// Of a document by a post; of any other what its format says.
[[nodiscard]] ProgramFile program_file(
    const FormatName& format, const FormatOptions& options, std::string_view endpoint,
    const std::vector<std::pair<std::string, std::string>>& reference,
    std::string_view input_sha256);

}  // namespace tubecut::api
