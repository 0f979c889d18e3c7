#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "api/api.hpp"
#include "server/http.hpp"
#include "server/identity.hpp"

namespace tubecut::server {

/// What became of one request, for the log and the metrics: never its geometry.
struct JobRecord {
  api::JobFacts facts = {};
  std::string method = {};
  std::string request_id = {};
  std::string traceparent = {};
  std::string failure = {};  // text of an unexpected exception; the caller never sees it
  int status = 0;
  double seconds = 0.0;
  std::size_t bytes_in = 0;
  std::size_t bytes_out = 0;
};

struct AppOptions {
  std::string replica = {};  // value of Tubecut-Replica
  std::size_t max_target_bytes = 2048;
  std::size_t max_body_bytes = 8u << 20;  // lowers the endpoints' own limits, never raises them
  std::stop_token stop = {};              // cancels every job
  std::function<api::Outcome(const api::Call&, const api::Context&)> dispatch = api::dispatch;
  std::function<void()> started = [] {};
  std::function<void(const JobRecord&)> finished = [](const JobRecord&) {};
};

/// The service without sockets: one whole request in, one whole answer out. Safe to call from many
/// threads.
class App {
 public:
  explicit App(AppOptions options) : x_(std::move(options)) {}

  /// Answers a request. Never throws for what a client sends, nor for a bug below: that is a 500
  /// with a request id, its text only in the record.
  [[nodiscard]] Response handle(const Request& request) const;

  /// What can be told from the request line and the headers alone, so that a body need not be read
  /// to be refused.
  [[nodiscard]] std::optional<Refusal> screen(const Request& head) const;

  /// Largest body taken by the target's path, in bytes.
  [[nodiscard]] std::size_t max_body(std::string_view target) const;

 private:
  [[nodiscard]] api::Outcome answer(const Request& request, const Identity& id) const;
  [[nodiscard]] api::Outcome answer_guarded(const Request& request, const Identity& id,
                                            std::string& failure) const;
  [[nodiscard]] api::Outcome refuse(const Refusal& refusal, const Identity& id) const;
  [[nodiscard]] api::Context context() const;

  AppOptions x_;
};

/// Monotonic seconds.
[[nodiscard]] double steady_seconds();

}  // namespace tubecut::server
