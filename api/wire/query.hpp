#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/wire/format.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

/// The query string of a request: the requested form of its answer.
struct Query {
  bool validate_only = false;
  std::string format;  // empty: by Accept
  std::string view;    // empty: the format's default
  FormatOptions options;
  Json::Object given;  // the options that are there, as sent
};

/// A query string with defaults applied, and all its errors. Pointers are "?name".
struct ParsedQuery {
  Query query;
  std::vector<FieldIssue> issues;
};

/// The query string after its "?": `name=value` joined by "&", percent-encoded. Read by the strict
/// reader of bodies: unknown names, names given twice, values not offered or out of range.
[[nodiscard]] ParsedQuery parse_query(std::string_view text);

/// Returns issues for a path without parameters: each given one is an error.
[[nodiscard]] std::vector<FieldIssue> refuse_parameters(std::string_view text);

}  // namespace tubecut::api
