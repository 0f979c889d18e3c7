#pragma once

#include <string>
#include <vector>

#include "api/wire/reader.hpp"

namespace tubecut::api {

/// Decodes `columns` of a request: names of the columns of a table to print; empty: all. `known`:
/// all possible columns; `there`: those of this table, if the request is valid so far.
[[nodiscard]] std::vector<std::string> decode_columns(Reader& in,
                                                      const std::vector<std::string>& known,
                                                      const std::vector<std::string>& there);

}  // namespace tubecut::api
