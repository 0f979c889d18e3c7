#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/api.hpp"
#include "api/reader.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {

/// A request refused: the top code, one sentence, and what is wrong with each field.
struct Problem {
  ErrorCode code = ErrorCode::internal_error;
  std::string detail = {};
  std::vector<FieldIssue> issues = {};
};

/// Field issues as one problem: their own code when they agree on it, else `invalid_request`.
[[nodiscard]] Problem field_problem(std::vector<FieldIssue> issues);

/// A core error, its members mapped to pointers into the request as it was understood.
[[nodiscard]] Problem core_problem(const Error& error, const Json& request);

/// The first check that does not hold; an answer with one is withheld.
[[nodiscard]] std::optional<Problem> failed_check(const std::vector<Check>& checks);

/// "cutters/1/offset" -> "/cutters/1/offset_mm", by the names the request has.
[[nodiscard]] std::string pointer_of(std::string_view member, const Json& request);

/// application/problem+json (RFC 9457).
[[nodiscard]] std::string print(const Problem& problem, std::string_view request_id, int status);

}  // namespace tubecut::api
