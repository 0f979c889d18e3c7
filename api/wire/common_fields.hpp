#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/verdict.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

/// Fields that belong to every request.
struct CommonFields {
  std::vector<std::pair<std::string, std::string>> reference;
  Json reference_echo;
  bool inline_log = false;
  std::optional<int> numerics;
  std::vector<Measure> accept;
};

/// `accepts`: the names that `accept` may have; without any it is an unknown field.
[[nodiscard]] CommonFields read_common_fields(Reader& in,
                                              std::span<const std::string_view> accepts);

/// Reads the same of a request inside another, which may be a pasted echo: its `reference` and
/// `log` are read and echoed, its `numerics` must be the engine's, and an `accept`, which has no
/// effect there, is an issue.
void read_inner_common_fields(Reader& in);

}  // namespace tubecut::api
