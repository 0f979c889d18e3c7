#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "api/api.hpp"
#include "server/access.hpp"
#include "server/hosts.hpp"
#include "server/http/http.hpp"
#include "server/identity.hpp"

namespace tubecut::server {

/// Outcome of one request, for the log and the metrics; never its geometry.
struct JobRecord {
  api::JobFacts facts = {};
  std::string method = {};
  std::string request_id = {};
  std::string traceparent = {};
  std::string replica = {};
  std::string client = {};    // address; a forwarded one only from a trusted proxy
  std::string identity = {};  // owner of the key; empty without keys
  std::string failure = {};   // text of an unexpected exception; the caller never sees it
  int status = 0;
  double seconds = 0.0;  // in `handle`
  double cpu = 0.0;      // seconds that all threads had for it; 0: no slot began it
  std::size_t bytes_in = 0;
  std::size_t bytes_out = 0;
  std::size_t memory = 0;  // the most bytes it took at a time, its body aside; 0: not known
  std::optional<BatchCount> batch = {};  // of its lines, which have records of their own
  Times times = {};                      // as the transport saw it, monotonic
  double begun = 0.0;                    // `handle` was called, monotonic seconds
  double sent = 0.0;                     // the last byte was handed to the kernel; 0: it never was
};

struct AppOptions {
  std::string replica = {};  // value of Tubecut-Replica
  std::size_t max_target_bytes = 8192;
  std::size_t max_body_bytes = 8u << 20;  // lowers the endpoints' own limits, never raises them
  /// Largest body of a job of any endpoint that fits in the memory; the transport refuses larger
  /// ones.
  std::size_t max_job_body_bytes = std::numeric_limits<std::size_t>::max();
  /// Bytes that jobs and answers share.
  std::size_t memory = std::numeric_limits<std::size_t>::max();
  std::stop_token stop = {};                      // cancels every job
  std::chrono::milliseconds budget{0};            // CPU of any job; 0: the endpoint's default
  std::vector<std::string> cors_origins = {};     // "https://plant.example"; empty: no CORS
  std::vector<std::string> trusted_proxies = {};  // proxies whose X-Forwarded-For is trusted
  /// Names by which Host may call the service, in addition to those of this machine; nullopt: any
  /// name. Otherwise a page could rebind its name to this machine's address and reach the service
  /// from a browser.
  Hosts hosts = {};
  std::shared_ptr<Access> access = {};  // empty: no keys
  std::function<api::Outcome(const api::Call&, const api::Context&)> dispatch = api::dispatch;
  std::function<void()> started = [] {};
  std::function<void(const JobRecord&)> finished = [](const JobRecord&) {};
  /// The answer has left, or its client has.
  std::function<void(const JobRecord&)> sent = [](const JobRecord&) {};
};

/// Milliseconds of CPU a client gives its job; lowers the service's own budget, never raises it.
inline constexpr std::string_view kBudgetHeader = "Tubecut-Budget-Ms";

/// The service without sockets: one whole request in, one whole answer out. Safe to call from many
/// threads.
class App {
 public:
  explicit App(AppOptions options) : x_(std::move(options)) {}

  /// Answers a request. Never throws, neither for a client's input nor for a bug below: that
  /// becomes a 500 with a request id, and only the record has its text.
  [[nodiscard]] Response handle(const Request& request) const;

  /// Returns a refusal if the request line and the headers are enough to refuse the request, so
  /// that its body need not be read.
  [[nodiscard]] std::optional<Refusal> screen(const Request& head) const;

  /// Largest body taken by the target's path, in bytes.
  [[nodiscard]] std::size_t max_body(std::string_view target) const;

  /// Whether a whole request may be worked on now: its key's rate.
  [[nodiscard]] std::optional<Refusal> admit(const Request& request) const;

  /// Is it POST /v1/batches?
  [[nodiscard]] static bool is_batch(const Request& request);

  /// Status and headers of a batch's answer; another status than 200: `handle` refuses it.
  [[nodiscard]] Response batch_head(const Request& request) const;

  /// Answers one line of a batch and logs and counts it like a single request: X-Request-Id is the
  /// batch's with the line's number, Job-Id the line's id if it is valid. The headers are the
  /// batch's.
  [[nodiscard]] BatchReply line(const Request& request) const;

  /// The last line of a batch's answer, as the body; logs and counts the batch itself.
  [[nodiscard]] Response summary(const Request& head, const BatchCount& count) const;

  /// Bytes of memory that are reserved for the job before it begins.
  [[nodiscard]] static std::size_t memory(const Request& request);

  /// Returns the largest body for the target's path whose job fits in the memory.
  [[nodiscard]] std::size_t room(std::string_view target) const;

  /// Returns the client of the request: the owner of its key, else its address.
  [[nodiscard]] std::string client(const Request& request) const;

  /// Returns whether the job is of the short class: by its endpoint and the size of its body.
  /// Catalogues are, lines of batches are not.
  [[nodiscard]] static bool is_short(const Request& request);

  /// Is it the address of a trusted proxy?
  [[nodiscard]] bool is_proxy(const std::string& peer) const;

  [[nodiscard]] Budget budget(const Request& request) const;

 private:
  [[nodiscard]] api::Outcome answer(const Request& request, const Identity& id) const;
  [[nodiscard]] api::Outcome answer_guarded(const Request& request, const Identity& id,
                                            std::string& failure) const;
  [[nodiscard]] api::Outcome refuse(const Refusal& refusal, const Identity& id) const;
  [[nodiscard]] api::Context context() const;
  [[nodiscard]] api::Context context(const Request& request) const;
  [[nodiscard]] std::optional<Response> preflight(const Request& request) const;
  void allow_origin(const Request& request, Headers& headers) const;
  [[nodiscard]] BatchReply answer_line(const Request& request) const;
  [[nodiscard]] static std::optional<Refusal> batch_fault(const Request& request);
  void tell(JobRecord record, const Request& request, Response& response) const;
  [[nodiscard]] std::string identity_of(const Request& request) const;

  AppOptions x_;
};

/// Monotonic seconds.
[[nodiscard]] double steady_seconds();

}  // namespace tubecut::server
