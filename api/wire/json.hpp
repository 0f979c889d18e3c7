#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "core/base/variant.hpp"

namespace tubecut::api {

/// A JSON document as a plain value. Objects keep the order of their members; numbers are doubles
/// (integers beyond 2^53 are refused while parsing). Made only by `parse`; requests are read only
/// through `Reader`.
struct Json {
  using Array = std::vector<Json>;
  using Member = std::pair<std::string, Json>;
  using Object = std::vector<Member>;
  Variant<std::nullptr_t, bool, double, std::string, Array, Object> value = nullptr;

  Json() = default;
  Json(bool v) : value(v) {}                      // NOLINT(google-explicit-constructor)
  Json(double v) : value(v) {}                    // NOLINT(google-explicit-constructor)
  Json(std::string v) : value(std::move(v)) {}    // NOLINT(google-explicit-constructor)
  Json(const char* v) : value(std::string(v)) {}  // NOLINT(google-explicit-constructor)
  Json(Array v) : value(std::move(v)) {}          // NOLINT(google-explicit-constructor)
  Json(Object v) : value(std::move(v)) {}         // NOLINT(google-explicit-constructor)

  template <class T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  template <class T>
  [[nodiscard]] T* as() {
    return std::get_if<T>(&value);
  }

  /// The member of that name, or nullptr (also when this is not an object).
  [[nodiscard]] const Json* find(std::string_view key) const;

  friend bool operator==(const Json&, const Json&) = default;
};

/// Why bytes are not one strict JSON document.
struct ParseError {
  std::size_t offset = 0;  // bytes from the start
  std::string reason;
};

struct ParseLimits {
  std::size_t depth = 32;
};

/// Strict RFC 8259: UTF-8 without BOM, one document, no duplicate keys, no lone surrogates, depth
/// bounded, every number finite and representable (no underflow to zero, no integer beyond 2^53).
/// Cost linear in the bytes; throws but Stopped.
[[nodiscard]] tl::expected<Json, ParseError> parse(std::string_view bytes,
                                                   const ParseLimits& limits = {});

/// Appends a JSON string or number token. `value` must be finite.
void append_text(std::string& out, std::string_view text);
void append_number(std::string& out, double value);
/// Writes the same token at `to`, which has room for kNumberBytes; returns its end.
inline constexpr std::size_t kNumberBytes = 32;
[[nodiscard]] char* print_number(char* to, double value);

}  // namespace tubecut::api
