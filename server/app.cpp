#include "server/app.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "server/identity.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

constexpr std::string_view kRetryAfterSeconds =
    "1";  // a job takes milliseconds, a restart about a second

bool visible(char c) { return c > 0x20 && c < 0x7f; }

/// HEAD asks for the head of what GET answers.
std::string_view asked_method(const Request& request) {
  return request.method == "HEAD" ? std::string_view("GET") : std::string_view(request.method);
}

api::Call call_of(const Request& request, const Identity& id) {
  return {.method = asked_method(request),
          .path = path_of(request.target),
          .query = query_of(request.target),
          .accept = header(request.headers, "Accept"),
          .content_type = header(request.headers, "Content-Type"),
          .body = request.body,
          .job_id = id.job_id,
          .request_id = id.request_id};
}

std::string server_timing(const std::vector<api::Stage>& stages, double total_s) {
  std::string out;
  for (const auto& stage : stages) {
    out += fmt::format("{};dur={:.3f}, ", stage.name, 1e3 * stage.seconds);
  }
  return out + fmt::format("total;dur={:.3f}", 1e3 * total_s);
}

/// A charset is named so that no transport compresses answers behind our back (a setting of the
/// library keyed on the bare type made answers 240 times slower).
std::string with_charset(std::string type) {
  return type == "application/json" ? "application/json; charset=utf-8" : std::move(type);
}

/// Whoever may GET may HEAD.
std::string with_head(std::string_view methods) {
  const bool get = methods.find("GET") != methods.npos;
  const bool head = methods.find("HEAD") != methods.npos;
  return std::string(methods) + (get && !head ? ", HEAD" : "");
}

void add_if(Headers& headers, std::string_view name, const std::string& value) {
  if (!value.empty()) headers.emplace_back(name, value);
}

Headers answer_headers(const api::Outcome& outcome, const Identity& id, int status) {
  Headers headers;
  for (const auto& [name, value] : outcome.headers) {
    headers.emplace_back(name, name == "Allow" ? with_head(value) : value);
  }
  headers.emplace_back("X-Request-Id", id.request_id);
  add_if(headers, "Job-Id", id.job_id_header);
  add_if(headers, "Idempotency-Key", id.idempotency_key);
  add_if(headers, "traceparent", id.traceparent);
  headers.emplace_back("X-Content-Type-Options", "nosniff");
  if (retryable(status)) headers.emplace_back("Retry-After", kRetryAfterSeconds);
  return headers;
}

}  // namespace

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::size_t App::max_body(std::string_view target) const {
  return std::min(api::max_body(path_of(target)), x_.max_body_bytes);
}

std::optional<Refusal> App::screen(const Request& head) const {
  if (head.refusal) return head.refusal;
  if (head.target.size() > x_.max_target_bytes) {
    return Refusal{ErrorCode::bad_request,
                   fmt::format("The target is {} bytes long; the limit is {}.", head.target.size(),
                               x_.max_target_bytes)};
  }
  if (!std::ranges::all_of(head.target, visible)) {
    return Refusal{ErrorCode::bad_request, "The target holds a byte that is not visible ASCII."};
  }
  const auto encoding = header(head.headers, "Content-Encoding");
  if (!encoding.empty() && !equal_ignoring_case(encoding, "identity")) {
    return Refusal{ErrorCode::unsupported_encoding,
                   "Content-Encoding is not accepted on requests."};
  }
  return job_name_fault(head.headers);
}

api::Context App::context() const {
  return {.stop = x_.stop, .clock = steady_seconds, .status = status_of};
}

api::Outcome App::refuse(const Refusal& refusal, const Identity& id) const {
  return api::problem(refusal.code, refusal.detail, id.request_id, context());
}

api::Outcome App::answer(const Request& request, const Identity& id) const {
  if (const auto refusal = screen(request)) return refuse(*refusal, id);
  if (const auto limit = max_body(request.target); request.body.size() > limit) {
    return refuse(
        {ErrorCode::body_too_large, fmt::format("The body is larger than {} bytes.", limit)}, id);
  }
  api::Context with = context();
  if (request.stop.stop_possible()) with.stop = request.stop;
  api::Outcome outcome = x_.dispatch(call_of(request, id), with);
  // A job cut off by our own stop is not the job's fault: the same request succeeds elsewhere, or
  // here a second later.
  if (outcome.error == ErrorKind::timeout && x_.stop.stop_requested()) {
    return refuse({ErrorCode::unavailable, "The service is stopping."}, id);
  }
  return outcome;
}

/// The one place where an exception ends.
api::Outcome App::answer_guarded(const Request& request, const Identity& id,
                                 std::string& failure) const {
  try {
    return answer(request, id);
  } catch (const std::exception& bug) {
    failure = bug.what();
  } catch (...) {
    failure = "an exception that is no std::exception";
  }
  return refuse({ErrorCode::internal_error,
                 "The service failed; its log names the cause under this request id."},
                id);
}

Response App::handle(const Request& request) const {
  const double start = steady_seconds();
  x_.started();
  const Identity id = identify(request.headers);
  JobRecord record{
      .method = request.method, .request_id = id.request_id, .traceparent = id.traceparent};
  api::Outcome outcome = answer_guarded(request, id, record.failure);

  Response response{.status = outcome.error ? status_of(*outcome.error) : 200,
                    .content_type = with_charset(std::move(outcome.content_type)),
                    .body = std::move(outcome.body)};
  response.headers = answer_headers(outcome, id, response.status);
  add_if(response.headers, "Tubecut-Replica", x_.replica);
  record.seconds = steady_seconds() - start;
  response.headers.emplace_back("Server-Timing", server_timing(outcome.job.stages, record.seconds));

  record.facts = std::move(outcome.job);
  if (record.facts.id.empty()) record.facts.id = id.job_id;
  record.status = response.status;
  record.bytes_in = request.body.size();
  record.bytes_out = response.body.size();
  x_.finished(record);
  return response;
}

}  // namespace tubecut::server
