#pragma once

#include <string>
#include <vector>

#include "api/wire/reader.hpp"

namespace tubecut::api {

/// `columns` of a request: which of a table's columns are printed, by name; empty: all. `known`:
/// those there may be; `there`: those of this very table, where the request is understood so far.
[[nodiscard]] std::vector<std::string> decode_columns(Reader& in,
                                                      const std::vector<std::string>& known,
                                                      const std::vector<std::string>& there);

}  // namespace tubecut::api
