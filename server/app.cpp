#include "server/app.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <exception>

#include "core/base/stop.hpp"
#include "server/http/coding.hpp"
#include "server/http/networks.hpp"
#include "server/http/static_files.hpp"
#include "server/identity.hpp"
#include "server/jobs/job_memory.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

constexpr std::string_view kExposed =
    "X-Request-Id, Job-Id, Idempotency-Key, traceparent, Server-Timing, Retry-After, "
    "Tubecut-Replica, Tubecut-Input-Sha256, Tubecut-Result-Sha256, Tubecut-Verdict, "
    "Content-Disposition";
constexpr std::string_view kAllowed =
    "Content-Type, Authorization, X-Api-Key, Job-Id, Idempotency-Key, X-Request-Id, traceparent, "
    "Tubecut-Budget-Ms";

bool visible(char c) { return c > 0x20 && c < 0x7f; }

/// HEAD returns the head of the GET answer.
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

std::string server_timing(const JobRecord& job) {
  std::string out;
  for (const auto& stage : job.facts.stages) {
    out += fmt::format("{};dur={:.3f}, ", stage.name, 1e3 * stage.seconds);
  }
  return out + fmt::format("cpu;dur={:.3f}, total;dur={:.3f}", 1e3 * job.cpu, 1e3 * job.seconds);
}

/// A charset is named so that no transport compresses answers behind our back (a setting of the
/// library keyed on the bare type made answers 240 times slower).
std::string with_charset(std::string type) {
  return type == "application/json" ? "application/json; charset=utf-8" : std::move(type);
}

/// A job that wants more memory than there is.
Refusal refusal_of(const NoRoom& memory) {
  if (memory.ever_fits) return {ErrorCode::overloaded, "The memory for jobs is in use."};
  return {ErrorCode::body_too_large, "The job needs more memory than this replica has."};
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

/// Returns the time in ms that a client gives its job; 0 if it gives no time, nothing if the value
/// is not valid.
std::optional<std::chrono::milliseconds> asked_budget(const Headers& headers) {
  const auto values = header_values(headers, kBudgetHeader);
  if (values.empty()) return std::chrono::milliseconds(0);
  std::int64_t ms = 0;
  const auto text = values.front();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ms);
  const bool sound = values.size() == 1 && error == std::errc{} &&
                     end == text.data() + text.size() && ms >= 1 && ms <= 3'600'000;
  return sound ? std::optional(std::chrono::milliseconds(ms)) : std::nullopt;
}

bool asks_preflight(const Request& request) {
  return request.method == "OPTIONS" && !header(request.headers, "Origin").empty() &&
         !header(request.headers, "Access-Control-Request-Method").empty();
}

/// What is wrong with the media type of a body that waits for "100 Continue". Others are refused
/// with their bodies.
std::optional<Refusal> media_fault(const Request& head) {
  const auto endpoint = api::endpoint_at(path_of(head.target));
  if (header(head.headers, "Expect").empty() || head.method != "POST" || endpoint.empty())
    return std::nullopt;
  const std::string_view wanted =
      endpoint == "batches" ? "application/x-ndjson" : "application/json";
  auto media = header(head.headers, "Content-Type");
  media = media.substr(0, media.find_first_of("; \t"));
  if (equal_ignoring_case(media, wanted)) return std::nullopt;
  return Refusal{ErrorCode::unsupported_media_type, fmt::format("Send the body as {}.", wanted)};
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
  if (status == 401) headers.emplace_back("WWW-Authenticate", "Bearer");
  return headers;
}

/// The endpoints with short jobs, and the largest body of one. At all others every job is long,
/// because a small body can ask for minutes of cutting or thousands of positions there.
struct ShortUpTo {
  std::string_view endpoint;
  std::size_t bytes;
};
constexpr auto kShort = std::to_array<ShortUpTo>({
    {"intersections", 64u << 10},
    {"bevel-tables", 64u << 10},
    {"holes", 64u << 10},
    {"feed-curves", 64u << 10},
    {"grooves", 64u << 10},
    {"replays", 64u << 10},
    {"parts", 4u << 10},
});

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
  for (const auto* once : {"Content-Type", "X-Api-Key"})
    if (header_values(head.headers, once).size() > 1)
      return Refusal{ErrorCode::bad_request, fmt::format("{} is sent more than once.", once)};
  const bool names_host = !header_values(head.headers, "Host").empty();  // HTTP/1.0 may not
  if (names_host && !called_by(header(head.headers, "Host"), x_.hosts)) {
    return Refusal{ErrorCode::bad_request, std::string(kForeignHost)};
  }
  const auto encoding = header(head.headers, "Content-Encoding");
  if (!encoding.empty() && !equal_ignoring_case(encoding, "identity")) {
    return Refusal{ErrorCode::unsupported_encoding,
                   "Content-Encoding is not accepted on requests."};
  }
  if (!asked_budget(head.headers)) {
    return Refusal{ErrorCode::bad_request,
                   fmt::format("{} must be sent once and be a whole number from 1 to 3600000.",
                               kBudgetHeader)};
  }
  if (auto fault = job_name_fault(head.headers)) return fault;
  if (auto fault = media_fault(head)) return fault;
  if (!x_.access || asks_preflight(head)) return std::nullopt;
  const auto identity = x_.access->identify(head.headers);
  return identity ? std::nullopt : std::optional(identity.error());
}

std::optional<Refusal> App::admit(const Request& request) const {
  if (!x_.access || !x_.access->asks()) return std::nullopt;
  const auto identity = x_.access->identify(request.headers);
  return identity ? x_.access->take_rate_token(*identity, steady_seconds()) : std::nullopt;
}

std::size_t App::memory(const Request& request) {
  return api::reserved_per_byte(path_of(request.target)) * request.body.size();
}

std::size_t App::room(std::string_view target) const {
  return x_.memory / api::reserved_per_byte(path_of(target));
}

std::string App::client(const Request& request) const {
  if (x_.access && x_.access->asks()) return "key " + identity_of(request);
  return client_of(request, x_.trusted_proxies);
}

bool App::is_short(const Request& request) {
  if (request.method != "POST") return true;
  const auto endpoint = api::endpoint_at(path_of(request.target));
  const auto* const row = std::ranges::find(kShort, endpoint, &ShortUpTo::endpoint);
  return request.line == 0 && row != kShort.end() && request.body.size() <= row->bytes;
}

bool App::is_proxy(const std::string& peer) const { return in_networks(peer, x_.trusted_proxies); }

Budget App::budget(const Request& request) const {
  const auto own = api::budget_s(path_of(request.target), context());
  auto cpu = std::chrono::milliseconds(std::llround(1e3 * own));
  const auto asked = asked_budget(request.headers);
  if (asked && asked->count() > 0) cpu = std::min(*asked, cpu);
  return {.cpu = cpu, .wall = api::kWallPerCpu * cpu};
}

/// The browser's question before a request from another origin (Fetch, 3.2.2).
std::optional<Response> App::preflight(const Request& request) const {
  if (!asks_preflight(request) || request.refusal || x_.cors_origins.empty()) return std::nullopt;
  Response response{.status = 204};
  allow_origin(request, response.headers);
  if (header(response.headers, "Access-Control-Allow-Origin").empty()) return std::nullopt;
  response.headers.emplace_back("Access-Control-Allow-Methods", "GET, POST");
  response.headers.emplace_back("Access-Control-Allow-Headers", kAllowed);
  response.headers.emplace_back("Access-Control-Max-Age", "7200");
  return response;
}

void App::allow_origin(const Request& request, Headers& headers) const {
  if (x_.cors_origins.empty()) return;
  headers.emplace_back("Vary", "Origin");
  const auto origin = header(request.headers, "Origin");
  if (std::ranges::find(x_.cors_origins, origin) == x_.cors_origins.end()) return;
  headers.emplace_back("Access-Control-Allow-Origin", origin);
  headers.emplace_back("Access-Control-Expose-Headers", kExposed);
}

api::Context App::context() const {
  return {.clock = steady_seconds,
          .status = status_of,
          .max_body = std::min(x_.max_body_bytes, x_.max_job_body_bytes),
          .budget_s = std::chrono::duration<double>(x_.budget).count()};
}

api::Context App::context(const Request& request) const {
  api::Context with = context();
  with.parallel_for = request.parallel_for;
  with.call_budget_s = std::chrono::duration<double>(budget(request).cpu).count();
  return with;
}

api::Outcome App::refuse(const Refusal& refusal, const Identity& id) const {
  return api::problem(refusal.code, refusal.detail, id.request_id, context(), refusal.pointer);
}

api::Outcome App::answer(const Request& request, const Identity& id) const {
  if (const auto refusal = screen(request)) return refuse(*refusal, id);
  if (const auto limit = max_body(request.target); request.body.size() > limit) {
    return refuse(
        {ErrorCode::body_too_large, fmt::format("The body is larger than {} bytes.", limit)}, id);
  }
  if (is_batch(request))
    if (const auto fault = batch_fault(request)) return refuse(*fault, id);
  const StopScope scope(request.stop.stop_possible() ? request.stop : x_.stop);
  api::Context with = context(request);
  with.received = request.times.received;
  api::Outcome outcome = x_.dispatch(call_of(request, id), with);
  // A job cut off by our own stop is not the job's fault: the same request succeeds elsewhere, or
  // here a second later.
  if (outcome.error == ErrorKind::timeout && x_.stop.stop_requested()) {
    return refuse({ErrorCode::unavailable, "The service is stopping."}, id);
  }
  return outcome;
}

/// The only place that catches all exceptions.
api::Outcome App::answer_guarded(const Request& request, const Identity& id,
                                 std::string& failure) const {
  try {
    return answer(request, id);
  } catch (const NoRoom& memory) {
    return refuse(refusal_of(memory), id);
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
  try {
    if (auto page = static_answer(request, static_files())) return *std::move(page);  // no job
  } catch (const NoRoom& memory) {  // for a file that has to be unpacked
    Request refused = request;
    refused.refusal = refusal_of(memory);
    return handle(refused);
  }
  const double start = steady_seconds();
  if (auto response = preflight(request)) return *std::move(response);
  x_.started();
  const Identity id = identify(request.headers);
  JobRecord record{.method = request.method,
                   .request_id = id.request_id,
                   .traceparent = id.traceparent,
                   .replica = x_.replica,
                   .client = client_of(request, x_.trusted_proxies),
                   .bytes_in = request.body.size(),
                   .times = request.times,
                   .begun = start};
  api::Outcome outcome = answer_guarded(request, id, record.failure);

  Response response{.status = outcome.error ? status_of(*outcome.error) : 200,
                    .content_type = with_charset(std::move(outcome.content_type)),
                    .body = std::move(outcome.body),
                    .lines = std::move(outcome.lines)};
  response.headers = answer_headers(outcome, id, response.status);
  if (retryable(response.status)) {
    const int wait = request.refusal ? request.refusal->retry_after_s : 1;
    response.headers.emplace_back("Retry-After", std::to_string(wait));
  }
  allow_origin(request, response.headers);
  add_if(response.headers, "Tubecut-Replica", x_.replica);
  revalidate(request, response);
  compress(request, response);
  record.seconds = steady_seconds() - start;
  if (request.used_cpu) record.cpu = std::chrono::duration<double>(request.used_cpu()).count();
  record.facts = std::move(outcome.job);
  response.headers.emplace_back("Server-Timing", server_timing(record));
  if (record.facts.id.empty()) record.facts.id = id.job_id;
  if (record.facts.endpoint.empty())  // refused before it was read
    record.facts.endpoint = api::endpoint_at(path_of(request.target));
  record.status = response.status;
  record.bytes_out = response.body.size();
  record.memory = JobMemory::peak_here();
  record.identity = identity_of(request);
  tell(std::move(record), request, response);
  return response;
}

/// Returns the owner of the request's key; empty if the key is not valid.
std::string App::identity_of(const Request& request) const {
  return x_.access ? x_.access->identify(request.headers).value_or(std::string{}) : std::string{};
}

void App::tell(JobRecord record, const Request& request, Response& response) const {
  x_.finished(record);
  if (!request.reports_sending) return x_.sent(record);
  response.sent = [this, record = std::move(record)](bool whole) mutable {
    if (whole) record.sent = steady_seconds();
    x_.sent(record);
  };
}

}  // namespace tubecut::server
