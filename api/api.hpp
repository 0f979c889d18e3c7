#pragma once

/// The api layer's whole face: the only header of api that server includes.

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error_codes.hpp"
#include "core/base/parallel_for.hpp"

namespace tubecut::api {

/// One request as text; of HTTP only its terms.
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

/// The context of a call, in addition to its text.
struct Context {
  std::function<double()> clock;       // monotonic seconds, for stage times; may be empty
  double received = 0.0;               // when the request's first byte came, on that clock; 0: now
  int (*status)(ErrorKind) = nullptr;  // the number printed in a problem's `status`
  /// Largest body that this replica takes, if an endpoint takes more; `GET /v1/limits` shows it.
  std::size_t max_body = std::numeric_limits<std::size_t>::max();
  double budget_s = 0.0;                    // CPU of any job here; 0: the endpoint's default
  double call_budget_s = 0.0;               // CPU limit that this call requests; 0: the usual one
  ParallelFor parallel_for = run_in_order;  // runs independent tasks of the job
};

/// A job ends at the latest this many times its CPU budget after its request arrived, even if it
/// got little CPU. A replica with one slot works on two jobs at a time: each has half of a CPU,
/// half a budget may pass in the queue, and as much again is left for other processes.
inline constexpr int kWallPerCpu = 4;

/// Seconds of CPU for a call at a path.
[[nodiscard]] double budget_s(std::string_view path, const Context& context);

struct Stage {
  std::string_view name;  // parse, decode, compute, verify, encode
  double seconds = 0.0;
};

/// Returns the name of the end of a stage among a job's events: decoded, validated, computed,
/// verified, encoded.
[[nodiscard]] std::string_view event_of(std::string_view stage);

/// Facts of a call for a log line and the metrics: never the geometry.
struct JobFacts {
  std::string id;
  std::string endpoint;               // id in the endpoint table; empty when the path is not in it
  std::string input_sha256;           // empty if the request is not valid
  std::string result_sha256;          // empty for errors
  std::string body_sha256;            // hash of the body's bytes, if the request is not valid
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

/// Returns a problem document for a request that the server itself refuses (429, 503, 413 ...);
/// with a pointer, for an unknown query parameter.
[[nodiscard]] Outcome problem(ErrorCode code, std::string_view detail, std::string_view request_id,
                              const Context& context, std::string_view pointer = {});

/// Returns the ids of the endpoint table: the possible values of JobFacts::endpoint, unless empty.
[[nodiscard]] std::vector<std::string_view> endpoint_ids();

/// Largest body, in bytes, that the path takes.
[[nodiscard]] std::size_t max_body(std::string_view path);

/// Bytes of memory reserved for a job, before it begins, for each byte of its body: for its tree of
/// values, its echo and what an endpoint makes of it. The second is for endpoints that take large
/// bodies, and for lines of batches, which may name any endpoint. What a job needs in addition is
/// counted while it runs.
inline constexpr std::size_t kReservedPerByte = 48;
inline constexpr std::size_t kReservedPerByteOfLarge = 160;
[[nodiscard]] std::size_t reserved_per_byte(std::string_view path);

/// The id of the endpoint, or of the batches, at a path; empty for other paths.
[[nodiscard]] std::string_view endpoint_at(std::string_view path);

/// A JSON text and the file it is from.
struct FileText {
  std::string file;
  std::string json;
};

/// Adds these machines, each an object in the form of GET /v1/machines, to the built-in ones, in
/// place of the previous ones. If one has an error, changes nothing. Running jobs keep theirs.
/// Returns the first file with an error and the reason, or nothing.
[[nodiscard]] std::string set_machines(std::span<const FileText> texts);
/// The same of posts, in the form of GET /v1/posts.
[[nodiscard]] std::string set_posts(std::span<const FileText> texts);

/// Returns the hash of everything that an answer depends on in addition to its request: engine,
/// numerics, and every machine's and post's hash. If replicas differ in it, they may answer one
/// request with different bytes.
[[nodiscard]] std::string configuration_sha256();

/// An example the service carries: a request's body that runs.
struct Example {
  std::string_view endpoint;  // id
  std::string name;           // with the theme it belongs to, "commissioning/4-saddle"
  std::string_view body;
};
[[nodiscard]] std::vector<Example> examples();

/// "0.1.0", the commit that the binary is built from ("1a2b3c4d5e6f"; empty if the build does not
/// know it), and the integer that is raised with every change of a result bit.
[[nodiscard]] std::string_view version();
[[nodiscard]] std::string_view commit();
[[nodiscard]] int numerics();

/// "tubecut 0.1.0+1a2b3c4d5e6f": names the build in answers, logs and machine files. A comment of
/// G-code cannot contain parentheses.
[[nodiscard]] inline std::string engine() {
  const std::string of = commit().empty() ? "" : "+" + std::string(commit());
  return "tubecut " + std::string(version()) + of;
}

}  // namespace tubecut::api
