#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/api.hpp"

namespace tubecut::api {

/// Endpoint for many calls in one body, one line of JSON each, answered line by line.
inline constexpr std::string_view kBatchesId = "batches";
inline constexpr std::string_view kBatchesPath = "/v1/batches";
inline constexpr std::string_view kLinesMedia = "application/x-ndjson";

/// One line of a batch: `{"id": text, "endpoint": "bevel-tables", "body": {...}}`.
struct BatchLine {
  std::string id;     // empty: it could not be read
  std::string path;   // "/v1/bevel-tables"
  std::string query;  // "format=nc1", or empty
  std::string body;   // JSON, as the endpoint takes it
  std::optional<ErrorKind> error;
  std::string code;     // the error's, as in /v1/errors
  std::string problem;  // the document, if there is an error
};

/// Reads a line; one that cannot be worked on comes back with its problem.
[[nodiscard]] BatchLine read_batch_line(std::string_view line, std::string_view request_id,
                                        const Context& context);

/// Outcome of a line: the answer or problem in JSON, or a document of another `media`; `verdict` is
/// the header of that name.
struct BatchAnswer {
  int status = 0;
  std::string_view content;
  std::string_view media = "application/json";
  std::string_view verdict = {};
};

/// Returns the line of a batch's answer, with its line feed. `number` counts from 1. A document is
/// in `document`, or in `document_base64` if it is not text.
[[nodiscard]] std::string print_batch_line(const BatchLine& line, std::size_t number,
                                           const BatchAnswer& answer);

/// Returns the query that requests a format with its options, as in a URL.
[[nodiscard]] std::string format_query(
    std::string_view format, const std::vector<std::pair<std::string, std::string>>& options);

/// The last line: outcome counts of the received `lines`. Unanswered ones may be sent again.
struct BatchSummary {
  std::size_t items = 0;
  std::size_t answered = 0;  // with an answer
  std::size_t refused = 0;   // with a problem
};
[[nodiscard]] std::string print_batch_summary(const BatchSummary& summary);

}  // namespace tubecut::api
