#include "api/wire/json_number.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace tubecut::api {
namespace {

constexpr double kExact = 9007199254740992.0;  // 2^53
constexpr double kLeast = std::numeric_limits<double>::min();
constexpr double kMost = std::numeric_limits<double>::max();
constexpr std::size_t kShown = 80;

}  // namespace

std::optional<NumberFault> number_fault(double value, std::string_view text) {
  if (!std::isfinite(value)) return NumberFault{"number too large", kMost};
  const auto mantissa = text.substr(0, text.find_first_of("eE"));
  const bool zero = mantissa.find_first_of("123456789") == std::string_view::npos;
  if (!zero && std::abs(value) < kLeast) return NumberFault{"number too small", kLeast};
  const bool whole = text.find_first_of(".eE") == std::string_view::npos;
  if (whole && std::abs(value) > kExact) return NumberFault{"integer beyond 2^53", kExact};
  return std::nullopt;
}

std::optional<FieldIssue> number_issue(std::string_view json) {
  auto bad = find_bad_number(json);
  if (!bad) return std::nullopt;
  auto& text = bad->text;
  if (text.size() > kShown) text = text.substr(0, kShown) + "...";
  return FieldIssue{
      .code = ErrorCode::out_of_range,
      .pointer = std::move(bad->pointer),
      .got = Json{std::move(text)},
      .limit = Json{bad->fault.limit},
      .hint = std::string(bad->fault.reason) +
              ": an IEEE 754 double cannot hold it exactly; send a number within the limit"};
}

}  // namespace tubecut::api
