#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace tubecut::api {

/// How a check's limit is stated in `GET /v1/limits`.
struct CheckLimit {
  std::string_view name;
  std::string_view limit;  // a number, or the formula it follows
  std::string_view unit;
};

/// Lists of checks as one list.
template <std::size_t... N>
[[nodiscard]] constexpr auto all_checks(const std::array<CheckLimit, N>&... lists) {
  std::array<CheckLimit, (N + ...)> out{};
  auto at = out.begin();
  ((at = std::copy(lists.begin(), lists.end(), at)), ...);
  return out;
}

}  // namespace tubecut::api
