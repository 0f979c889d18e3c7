#pragma once

#include <functional>
#include <optional>
#include <stop_token>
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

/// A request refused: the top code, one sentence, and what is wrong with each field.
struct Problem {
  ErrorCode code = ErrorCode::internal_error;
  std::string detail = {};
  std::vector<FieldIssue> issues = {};
  std::vector<Warning> suspicions = {};  // of units that may be why; members are pointers
};

/// Field issues as one problem: their own code when they agree on it, else `invalid_request`.
[[nodiscard]] Problem field_problem(std::vector<FieldIssue> issues);

/// A core error, its members mapped to pointers into the request as it was understood.
[[nodiscard]] Problem core_problem(const Error& error, const Json& request);

/// The texts of the reference and of the request that a format of ASCII cannot spell, those of the
/// request where the line that met them holds them.
[[nodiscard]] Problem unspellable_problem(
    const Unspellable& met, const FormatName& format,
    const std::vector<std::pair<std::string, std::string>>& reference, const Json& request);

/// Pointers of the objects and arrays that the request as understood has and the body has not.
[[nodiscard]] std::vector<std::string> filled_in(const Json& body, const Json& request,
                                                 const std::stop_token& stop);

/// The same problem; what points into one of these places points to the place.
[[nodiscard]] Problem pointing_no_further(Problem problem, const std::vector<std::string>& places);

/// The first check that does not hold; an answer with one is withheld.
[[nodiscard]] std::optional<Problem> failed_check(const std::vector<Check>& checks);

/// Checks of many results as one of each name, the one that uses most of its limit.
void keep_worst(std::vector<Check>& worst, const std::vector<Check>& checks);

/// "cutters/1/offset" -> "/cutters/1/offset_mm", by the names the request has.
[[nodiscard]] std::string pointer_of(std::string_view member, const Json& request);

/// The same problem, with what the request's numbers look like in other units.
[[nodiscard]] Problem with_suspicions(Problem problem, const Json& request,
                                      const std::stop_token& stop);

/// Member `warnings` of an answer or a problem; `pointer` makes one of a warning's member.
void write_warnings(Writer& w, const std::vector<Warning>& warnings,
                    const std::function<std::string(const std::string&)>& pointer);

/// Member `errors` of a problem.
void write_issues(Writer& w, const std::vector<FieldIssue>& issues);

/// application/problem+json (RFC 9457).
[[nodiscard]] std::string print(const Problem& problem, std::string_view request_id, int status);

}  // namespace tubecut::api
