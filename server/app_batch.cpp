#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "api/api.hpp"
#include "api/batch.hpp"
#include "server/app.hpp"
#include "server/identity.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

constexpr std::size_t kPrefix = std::string_view("/v1/").size();

/// Returns the headers that every line's request inherits from the batch: identity and time limit.
/// Media types and names of the batch do not apply to lines.
Headers line_headers(const Headers& of_batch, std::string request_id) {
  Headers out;
  for (const auto* name : {"Authorization", "X-Api-Key", "X-Forwarded-For", "traceparent"})
    for (const auto value : header_values(of_batch, name)) out.emplace_back(name, value);
  out.emplace_back("Content-Type", "application/json");
  out.emplace_back("X-Request-Id", std::move(request_id));
  return out;
}

bool is_lines(std::string_view media) {
  return equal_ignoring_case(media.substr(0, media.find_first_of("; ")), api::kLinesMedia);
}

bool takes_lines(std::string_view accept) {
  return accept.empty() || accept.find("*/*") != accept.npos ||
         accept.find("application/*") != accept.npos ||
         accept.find(api::kLinesMedia) != accept.npos;
}

}  // namespace

bool App::is_batch(const Request& request) {
  return request.method == "POST" && path_of(request.target) == api::kBatchesPath;
}

std::optional<Refusal> App::batch_fault(const Request& request) {
  if (!is_lines(header(request.headers, "Content-Type")))
    return Refusal{ErrorCode::unsupported_media_type,
                   fmt::format("A batch is {}.", api::kLinesMedia)};
  if (!takes_lines(header(request.headers, "Accept")))
    return Refusal{ErrorCode::not_acceptable,
                   fmt::format("A batch is answered in {}.", api::kLinesMedia)};
  if (const auto query = query_of(request.target); !query.empty())
    return Refusal{.code = ErrorCode::bad_request,
                   .detail = "A batch has no query parameters; its lines name format and options.",
                   .pointer = "?" + std::string(query.substr(0, query.find_first_of("=&")))};
  return std::nullopt;
}

Response App::batch_head(const Request& request) const {
  if (batch_fault(request)) return {.status = 400};
  const Identity id = identify(request.headers);
  Response head{.content_type = std::string(api::kLinesMedia)};
  head.headers = {{"X-Request-Id", id.request_id}, {"X-Content-Type-Options", "nosniff"}};
  const std::pair<std::string_view, const std::string&> echoed[] = {
      {"Job-Id", id.job_id_header},
      {"Idempotency-Key", id.idempotency_key},
      {"traceparent", id.traceparent},
      {"Tubecut-Replica", x_.replica}};
  for (const auto& [name, value] : echoed)
    if (!value.empty()) head.headers.emplace_back(name, value);
  allow_origin(request, head.headers);
  return head;
}

BatchReply App::line(const Request& request) const {
  try {
    return answer_line(request);
  } catch (const std::exception&) {  // a slot's thread has nobody above to catch it
    const auto bug = api::problem(ErrorCode::internal_error, "The line failed.",
                                  header(request.headers, "X-Request-Id"), context());
    return {api::print_batch_line({}, request.line,
                                  {.status = status_of(*bug.error), .content = bug.body}),
            true};
  }
}

BatchReply App::answer_line(const Request& request) const {
  const auto batch_id = header(request.headers, "X-Request-Id");
  Request one = request;
  one.headers =
      line_headers(request.headers, fmt::format("{}-{}", batch_id.substr(0, 112), request.line));
  one.line = 0;
  one.reports_sending = false;
  const auto line = request.body.empty()  // refused, and too large to be read
                        ? api::BatchLine{}
                        : api::read_batch_line(request.body, header(one.headers, "X-Request-Id"),
                                               context(request));
  if (sound_id(line.id)) one.headers.emplace_back("Job-Id", line.id);
  if (line.error) {
    const int status = status_of(*line.error);
    JobRecord record{.facts = {.id = std::string(header(one.headers, "Job-Id")),
                               .endpoint = line.path.substr(std::min(line.path.size(), kPrefix)),
                               .error_code = line.code},
                     .method = "POST",
                     .request_id = std::string(header(one.headers, "X-Request-Id")),
                     .replica = x_.replica,
                     .client = client_of(request, x_.trusted_proxies),
                     .identity = identity_of(request),
                     .status = status,
                     .bytes_in = request.body.size(),
                     .bytes_out = line.problem.size(),
                     .times = request.times,
                     .begun = steady_seconds()};
    x_.started();
    x_.finished(record);
    if (request.logged) x_.sent(record);
    return {api::print_batch_line(line, request.line, {.status = status, .content = line.problem}),
            true, true};
  }
  one.method = "POST";
  one.target = line.query.empty() ? line.path : line.path + "?" + line.query;
  one.body = line.body;
  const Response response = handle(one);
  return {api::print_batch_line(line, request.line,
                                {.status = response.status,
                                 .content = response.body,
                                 .media = response.content_type,
                                 .verdict = header(response.headers, api::kVerdictHeader)}),
          response.status != 200};
}

Response App::summary(const Request& head, const BatchCount& count) const {
  const Identity id = identify(head.headers);
  const double now = steady_seconds();
  JobRecord record{.facts = {.id = id.job_id, .endpoint = std::string(api::kBatchesId)},
                   .method = "POST",
                   .request_id = id.request_id,
                   .traceparent = id.traceparent,
                   .replica = x_.replica,
                   .client = client_of(head, x_.trusted_proxies),
                   .identity = identity_of(head),
                   .status = 200,
                   .seconds = now - head.times.read,
                   .bytes_in = count.bytes_in,
                   .bytes_out = count.bytes_out,
                   .batch = count,
                   .times = head.times,
                   .begun = head.times.read};
  Response last{.body = api::print_batch_summary(
                    {.items = count.items, .answered = count.answered, .refused = count.refused})};
  x_.started();
  tell(std::move(record), head, last);
  return last;
}

}  // namespace tubecut::server
