#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error_codes.hpp"
#include "core/base/parallel_for.hpp"

/// Requests and answers as values: all that is left of HTTP once a transport has read a request.
namespace tubecut::server {

using Headers = std::vector<std::pair<std::string, std::string>>;

/// Why a request is turned away before it reaches the api.
struct Refusal {
  ErrorCode code = ErrorCode::bad_request;
  std::string detail = {};
  int retry_after_s = 1;     // a job takes milliseconds, a restart about a second
  std::string pointer = {};  // of the query parameter at fault, such as "?format"
};

/// When a request passed the transport, in monotonic seconds; 0: not known.
struct Times {
  double received = 0.0;  // its first byte
  double read = 0.0;      // its last byte
  double started = 0.0;   // a slot was free
};

struct Request {
  std::string method = {};
  std::string target = {};  // as sent: path and query, not decoded
  Headers headers = {};
  std::string body = {};
  std::string peer = {};                // address of the socket, never of a header
  std::optional<Refusal> refusal = {};  // set by a transport that could not read the request
  std::stop_token stop = {};            // ends the job: over its budget, or nobody waits for it
  Times times = {};
  bool reports_sending = false;  // the transport will call `Response::sent`
  std::size_t line = 0;          // of a batch, from 1; 0: a request by itself
  bool logged = true;            // a line of a batch that is not a job: whether it is logged
  ParallelFor parallel_for = run_in_order;  // by whom pieces of the job are done
  /// CPU that all threads have had for it since a slot began it; empty: no slot did.
  std::function<std::chrono::nanoseconds()> used_cpu = {};
};

/// Time limits of a job; 0: no limit.
struct Budget {
  std::chrono::milliseconds cpu{0};   // CPU of its threads: the load of other processes does not
                                      // count
  std::chrono::milliseconds wall{0};  // from its last byte in to its answer
};

/// The answer to one line of a batch.
struct BatchReply {
  std::string text = {};  // with its line feed
  bool refused = false;
  bool malformed = false;  // the line itself is malformed, so it is not a job
};

/// Outcome counts of a batch's lines.
struct BatchCount {
  std::size_t items = 0;
  std::size_t answered = 0;
  std::size_t refused = 0;
  std::size_t bytes_in = 0;
  std::size_t bytes_out = 0;
};

/// The body stays in the answer to a HEAD: its length is sent, the transport leaves the bytes out.
struct Response {
  int status = 200;
  std::string content_type = {};
  Headers headers = {};
  std::string body = {};
  /// Used instead of `body`: bytes that live as long as the program and are not copied.
  std::string_view fixed = {};
  /// Requests as a batch has them, one a line: their answers follow the body, in chunks.
  std::string lines = {};
  /// Called once: when the last byte is handed to the kernel (true), or never will be (false).
  std::function<void(bool whole)> sent = {};
};

/// Every value sent under `name` (any case), in the order sent.
[[nodiscard]] std::vector<std::string_view> header_values(const Headers& headers,
                                                          std::string_view name);

/// Returns the first value sent under `name`, or an empty text.
[[nodiscard]] std::string_view header(const Headers& headers, std::string_view name);

[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);

/// The target without its query, and the query without its '?'.
[[nodiscard]] std::string_view path_of(std::string_view target);
[[nodiscard]] std::string_view query_of(std::string_view target);

}  // namespace tubecut::server
