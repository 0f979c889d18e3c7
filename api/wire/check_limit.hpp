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

/// Lists as one list.
template <class T, std::size_t... N>
[[nodiscard]] constexpr auto joined(const std::array<T, N>&... lists) {
  std::array<T, (N + ...)> out{};
  auto at = out.begin();
  ((at = std::copy(lists.begin(), lists.end(), at)), ...);
  return out;
}

}  // namespace tubecut::api
