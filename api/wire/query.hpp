#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/wire/format.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

/// What the query string of a request asks of its answer.
struct Query {
  bool validate_only = false;
  std::string format;  // empty: by Accept
  std::string view;    // empty: the format's default
  FormatOptions options;
  Json::Object given;  // the options that are there, as sent
};

/// A query string as understood, and everything that is wrong with it. Pointers are "?name".
struct ParsedQuery {
  Query query;
  std::vector<FieldIssue> issues;
};

/// The query string after its "?": `name=value` joined by "&", percent-encoded. Read by the strict
/// reader of bodies: unknown names, names given twice, values not offered or out of range.
[[nodiscard]] ParsedQuery parse_query(std::string_view text);

/// The same where no parameter is read: whatever is there is wrong.
[[nodiscard]] std::vector<FieldIssue> refuse_parameters(std::string_view text);

}  // namespace tubecut::api
