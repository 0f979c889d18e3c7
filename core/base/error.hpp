#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "core/base/error_codes.hpp"
#include "core/base/variant.hpp"
#include "core/base/warning_codes.hpp"

namespace tubecut {

/// A closed interval [from, to], for example of phi in degrees.
using Intervals = std::vector<std::pair<double, double>>;

/// A value shown to the caller: the value received, or the limit.
using Shown = Variant<std::monostate, double, std::string, Intervals>;

/// One problem in a request. `member` is a path in core's own names, such as "cutters/1/offset"
/// (empty: the whole request); the api maps it to the wire's pointer. `got` and `limit` are in
/// `unit` (wire units: mm, deg, s).
struct Issue {
  ErrorCode code = ErrorCode::internal_error;
  std::string member = {};
  Shown got = {};
  Shown limit = {};
  std::string unit = {};
  std::string hint = {};
};

/// All problems in a request; never empty.
struct Error {
  std::vector<Issue> issues;

  Error(Issue issue) : issues{std::move(issue)} {}  // NOLINT(google-explicit-constructor)
  explicit Error(std::vector<Issue> all) : issues(std::move(all)) {}
  [[nodiscard]] ErrorCode code() const { return issues.front().code; }
};

template <class T>
using Result = tl::expected<T, Error>;

/// Returns an error: `return fail({.code = ErrorCode::no_contact, .member = "cutters"});`
[[nodiscard]] inline tl::unexpected<Error> fail(Issue issue) {
  return tl::unexpected<Error>(Error{std::move(issue)});
}

/// Errors  all `issues`, if any.
[[nodiscard]] inline Result<void> no_issues(std::vector<Issue> issues) {
  if (issues.empty()) return {};
  return tl::unexpected<Error>(Error{std::move(issues)});
}

/// A note for the caller on a valid answer. `member` as in `Issue`.
struct Warning {
  WarningCode code = WarningCode::cutter_missed;
  std::string member = {};
  std::string detail = {};
  double most = 0.0;  // the value of the detail, if warnings of the code are compared by it
};

/// One check of an answer: `value` must not exceed `limit`; either may be below zero.
struct Check {
  std::string name;
  double value = 0.0;
  double limit = 0.0;
  std::string unit;
  [[nodiscard]] bool passed() const { return value <= limit; }  // false for NaN
};

/// Sets `worst` to the larger of both. NaN counts as the largest, so it stays and fails its check.
inline void worsen(double& worst, double value) {
  worst = value > worst || value != value ? value : worst;
}
/// Returns the largest value; NaN if one is NaN.
[[nodiscard]] inline double worst_of(std::initializer_list<double> values) {
  double worst = *values.begin();
  for (const double value : values) worsen(worst, value);
  return worst;
}

struct ErrorInfo {
  std::string_view code;
  ErrorKind kind;
  std::string_view meaning;
  std::string_view action;
};
struct WarningInfo {
  std::string_view code;
  Severity severity;
  std::string_view meaning;
  std::string_view action;
};

/// Returns the shortest text that reads back as the same number.
[[nodiscard]] std::string shown(double value);
/// Returns a number as text for hints and details: six significant digits, 0 below 1e-9.
[[nodiscard]] std::string brief(double value);

[[nodiscard]] const ErrorInfo& info(ErrorCode code);
[[nodiscard]] const WarningInfo& info(WarningCode code);
[[nodiscard]] std::span<const ErrorInfo> all_errors();
[[nodiscard]] std::span<const WarningInfo> all_warnings();

}  // namespace tubecut
