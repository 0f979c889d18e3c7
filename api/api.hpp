#pragma once

/// The api layer's whole face: the only header of api that server includes.

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error_codes.hpp"
#include "core/base/turns.hpp"

namespace tubecut::api {

/// One request as text; nothing of HTTP but its words.
struct Call {
  std::string_view method;        // "POST", "GET", ...
  std::string_view path;          // without query, not decoded: known paths need no decoding
  std::string_view query;         // after '?', as sent
  std::string_view accept;        // Accept header, may be empty
  std::string_view content_type;  // Content-Type header, may be empty
  std::string_view body;
  std::string job_id;      // the client's, cleaned; empty: derived from the input hash
  std::string request_id;  // unique, made by the server
};

/// What a call runs with besides its text.
struct Context {
  std::stop_token stop;
  std::function<double()> clock;       // monotonic seconds, for stage times; may be empty
  double received = 0.0;               // when the request's first byte came, on that clock; 0: now
  int (*status)(ErrorKind) = nullptr;  // the number printed in a problem's `status`
  /// Bytes of body this replica takes, where an endpoint takes more; `GET /v1/limits` tells.
  std::size_t max_body = std::numeric_limits<std::size_t>::max();
  double budget_s = 0.0;       // CPU of any job here; 0: what its endpoint has by default
  double call_budget_s = 0.0;  // CPU that this call asked to be held to; 0: as any other job
  Turns turns = in_order;      // by whom pieces of the job are done that know
                               // nothing of each other
};

/// A job ends at the latest so many times its budget of CPU after its request came, whatever CPU it
/// got. A replica works at three jobs per slot at most (slot, lane and one that has outgrown the
/// lane): each has a third of a CPU, and half a budget may pass in the queue.
inline constexpr int kWallPerCpu = 4;

/// Seconds of CPU for a call at a path.
[[nodiscard]] double budget_s(std::string_view path, const Context& context);

struct Stage {
  std::string_view name;  // parse, decode, compute, verify, encode
  double seconds = 0.0;
};

/// What the end of a stage is called among a job's events: decoded, validated, computed, verified,
/// encoded.
[[nodiscard]] std::string_view event_of(std::string_view stage);

/// What a log line and the metrics may know of a call: never the geometry.
struct JobFacts {
  std::string id;
  std::string endpoint;               // id in the endpoint table; empty when the path is not in it
  std::string input_sha256;           // empty when the request was not understood
  std::string result_sha256;          // empty for errors
  std::string body_sha256;            // of the body's bytes, where that was not understood
  std::string verdict;                // ok | review | reject; empty for errors
  std::vector<std::string> reasons;   // of the verdict
  std::string error_code;             // empty for answers
  std::vector<std::string> warnings;  // codes
  std::vector<std::pair<std::string, std::string>> reference;
  std::vector<Stage> stages;
};

struct Outcome {
  std::optional<ErrorKind> error;  // empty: an answer
  std::string content_type;
  std::string body;
  std::string lines;  // of a batch, whose answers are the rest of this answer
  std::vector<std::pair<std::string, std::string>> headers;  // Allow and the like
  JobFacts job;
};

/// The header of every answer with a verdict: `review;reasons="free_end, standoff"`.
inline constexpr std::string_view kVerdictHeader = "Tubecut-Verdict";

/// Answers one call. Pure but for the clock: same call, same body. Never throws for bad input; a
/// bug throws and is the server's to turn into a 500.
[[nodiscard]] Outcome dispatch(const Call& call, const Context& context);

/// A problem document for what the server itself refuses (429, 503, 413 ...); with a pointer, for a
/// parameter of the query that it does not take.
[[nodiscard]] Outcome problem(ErrorCode code, std::string_view detail, std::string_view request_id,
                              const Context& context, std::string_view pointer = {});

/// Ids of the endpoint table: what JobFacts::endpoint can be, unless empty.
[[nodiscard]] std::vector<std::string_view> endpoint_ids();

/// Largest body, in bytes, that the path takes.
[[nodiscard]] std::size_t max_body(std::string_view path);

/// An upper bound of the memory that a call at a path takes by its body while it is answered; what
/// it asks for beside that comes on top (memory.hpp). Of no endpoint's path: that of the costliest.
struct CallMemory {
  std::size_t fixed = 0;
  std::size_t per_byte = 0;
};
[[nodiscard]] CallMemory call_memory(std::string_view path);

/// The same of a line of a batch, as bytes: by the costliest endpoint that it may name.
[[nodiscard]] std::size_t line_memory(std::string_view line);

/// The id of the endpoint, or of the batches, at a path; empty for other paths.
[[nodiscard]] std::string_view endpoint_at(std::string_view path);

/// A JSON text and the file it is from.
struct FileText {
  std::string file;
  std::string json;
};

/// Puts these, each an object in the form of GET /v1/machines, beside the built-in machines,
/// instead of those that were there: all of them, or none. Jobs that have begun keep theirs.
/// Returns the first file at fault and why, or nothing.
[[nodiscard]] std::string set_machines(std::span<const FileText> texts);
/// The same of posts, in the form of GET /v1/posts.
[[nodiscard]] std::string set_posts(std::span<const FileText> texts);

/// Of all that an answer depends on beside its request: engine, numerics, and every machine's and
/// post's hash.
/// Replicas where it differs may answer one request with other bytes.
[[nodiscard]] std::string configuration_sha256();

/// An example the service carries: a request's body that runs.
struct Example {
  std::string_view endpoint;  // id
  std::string name;           // with the theme it belongs to, "commissioning/4-saddle"
  std::string_view body;
};
[[nodiscard]] std::vector<Example> examples();

/// "0.1.0", and the integer raised with every change of a result bit.
[[nodiscard]] std::string_view version();
[[nodiscard]] int numerics();

}  // namespace tubecut::api
