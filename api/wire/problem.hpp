#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "api/wire/format.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/text_encoding.hpp"
#include "api/wire/writer.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {

/// A refused request: the top code, one sentence, and the error of each field.
struct Problem {
  ErrorCode code = ErrorCode::internal_error;
  std::string detail = {};
  std::vector<FieldIssue> issues = {};
  std::vector<Warning> suspicions = {};  // of units that may be why; members are pointers
};

/// Returns whether the same request may succeed a second later.
[[nodiscard]] bool retryable(ErrorKind kind);

/// Field issues as one problem: their own code when they agree on it, else `invalid_request`.
[[nodiscard]] Problem field_problem(std::vector<FieldIssue> issues);
/// Returns core's issue as one of a field.
[[nodiscard]] FieldIssue field_issue(Issue issue, std::string pointer);

/// Returns a core error, its members mapped to pointers into the request with defaults applied.
[[nodiscard]] Problem core_problem(const Error& error, const Json& request);

/// Returns the texts of the reference and of the request that an ASCII format cannot spell; those
/// of the request only if the line at fault contains them.
[[nodiscard]] Problem unspellable_problem(
    const Unspellable& met, const FormatName& format,
    const std::vector<std::pair<std::string, std::string>>& reference, const Json& request);

/// Returns pointers to the objects and arrays that the request with defaults has and the body has
/// not.
[[nodiscard]] std::vector<std::string> filled_in(const Json& body, const Json& request);

/// Returns the same problem; pointers into one of these places become pointers to the place.
[[nodiscard]] Problem pointing_no_further(Problem problem, const std::vector<std::string>& places);

/// The first check that does not hold; an answer with one is withheld.
[[nodiscard]] std::optional<Problem> failed_check(const std::vector<Check>& checks);

/// Checks of many results as one of each name, the one that uses most of its limit.
void keep_worst(std::vector<Check>& worst, const std::vector<Check>& checks);

/// "cutters/1/offset" -> "/cutters/1/offset_mm", by the names the request has.
[[nodiscard]] std::string pointer_of(std::string_view member, const Json& request);

/// Returns the same problem, with the units in which the request's numbers would be plausible.
[[nodiscard]] Problem with_suspicions(Problem problem, const Json& request);

/// Member `warnings` of an answer or a problem; `pointer` makes one of a warning's member.
void write_warnings(Writer& w, const std::vector<Warning>& warnings,
                    const std::function<std::string(const std::string&)>& pointer);

/// Member `errors` of a problem.
void write_issues(Writer& w, const std::vector<FieldIssue>& issues);

/// application/problem+json (RFC 9457).
[[nodiscard]] std::string print(const Problem& problem, std::string_view request_id, int status);

}  // namespace tubecut::api
