#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

/// `TRY(auto table, make(spec));` takes the value of a Result or returns its error to the caller;
/// `TRY(check(spec));` has no value to take. It is the only macro for control flow, because C++20
/// has no operator for it.
#define TRY(...) TUBECUT_TRY_PICK(__VA_ARGS__, TUBECUT_TRY_TAKE, TUBECUT_TRY_ONLY, )(__VA_ARGS__)
#define TUBECUT_TRY_PICK(first, second, name, ...) name
#define TUBECUT_TRY_ONLY(...)                                                                     \
  do {                                                                                            \
    if (auto tried = (__VA_ARGS__); !tried) return tl::make_unexpected(std::move(tried).error()); \
  } while (false)
#define TUBECUT_TRY_TAKE(into, ...) TUBECUT_TRY_AT(__LINE__, into, __VA_ARGS__)
#define TUBECUT_TRY_AT(line, ...) TUBECUT_TRY_NAMED(line, __VA_ARGS__)
#define TUBECUT_TRY_NAMED(line, into, ...) TUBECUT_TRY_AS(tried_##line, into, __VA_ARGS__)
#define TUBECUT_TRY_AS(tried, into, ...)                            \
  auto tried = (__VA_ARGS__);                                       \
  if (!tried) return tl::make_unexpected(std::move(tried).error()); \
  into = *std::move(tried)

namespace tubecut {

/// Returns the errors or warnings of a part of the request with paths of the whole: each path
/// begins with `where`.
template <class Told>
[[nodiscard]] std::vector<Told> under(std::string_view where, std::vector<Told> all) {
  for (auto& one : all)
    one.member = std::string(where) + (one.member.empty() ? "" : "/") + one.member;
  return all;
}
[[nodiscard]] inline Error under(std::string_view where, Error error) {
  return Error{under(where, std::move(error.issues))};
}
template <class T>
[[nodiscard]] Result<T> under(std::string_view where, Result<T> of) {
  return std::move(of).map_error([&](Error error) { return under(where, std::move(error)); });
}

}  // namespace tubecut
