#pragma once

#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "api/endpoint.hpp"
#include "api/wire/format.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/query.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {

inline constexpr std::string_view kJsonMedia = "application/json";
inline constexpr std::string_view kCborMedia = "application/cbor";

/// How an answer is printed.
struct FormatChoice {
  Encoding encoding = Encoding::json;
  const FormatName* format = nullptr;  // instead, unless nullptr
  bool by_lines = false;               // only the first part, with its lines left to request
};

/// Media type without parameters, in lower case.
[[nodiscard]] std::string media_of(std::string_view header);

/// `?format=` first, then of the types in Accept that there are the one of most weight, then JSON.
/// Errors  Returns the format, or `not_acceptable` with the supported ones; all unsupported options
///         and views at once; the required speed.
[[nodiscard]] tl::expected<FormatChoice, Problem> choose_format(const Query& query,
                                                                std::string_view accept,
                                                                const Endpoint& endpoint);

/// Returns all faults of a query string at once.
[[nodiscard]] Problem query_problem(std::vector<FieldIssue> issues,
                                    ErrorCode code = ErrorCode::bad_request);

}  // namespace tubecut::api
