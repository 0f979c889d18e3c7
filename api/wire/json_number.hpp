#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "api/wire/reader.hpp"

namespace tubecut::api {

/// Reason why a number of a JSON text is not a double, or nothing.
struct NumberFault {
  const char* reason = "";
  double limit = 0.0;
};
/// `text`: as it is written, "1e-400". A number other than 0 that a double can only hold with fewer
/// digits is too small; an integer without point or exponent is exact up to 2^53.
[[nodiscard]] std::optional<NumberFault> number_fault(double value, std::string_view text);

/// A number of a JSON text that no double holds, and its position.
struct BadNumber {
  std::string pointer = {}, text = {};
  NumberFault fault = {};
};
/// Returns the first of them, or nothing if the text ends or has an error before it.
[[nodiscard]] std::optional<BadNumber> find_bad_number(std::string_view json);

/// Returns the first number of a JSON text that no double holds, as an issue of its field
/// (out_of_range). Nothing if the text ends or has an error before it.
[[nodiscard]] std::optional<FieldIssue> number_issue(std::string_view json);

}  // namespace tubecut::api
