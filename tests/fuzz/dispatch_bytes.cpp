#include "tests/fuzz/dispatch_bytes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "api/api.hpp"
#include "api/batch.hpp"
#include "api/endpoint.hpp"
#include "api/wire/json.hpp"

namespace tubecut::fuzz {
namespace {

/// Indices in the corpus refer to these, so append new endpoints at the end. A batch's line uses
/// the endpoint that it names.
constexpr std::string_view kIds[] = {
    "intersections", "bevel-tables",    "feed-curves", "nodes", "holes",   "grooves",
    "mill-paths",    "pulse-schedules", "replays",     "parts", "batches", "frames"};

std::string_view id_at(unsigned byte) { return kIds[(byte & 15u) % std::size(kIds)]; }

const api::Endpoint* endpoint_of_id(std::string_view id) {
  for (const auto& endpoint : api::endpoints())
    if (endpoint.id == id) return &endpoint;
  return nullptr;
}

std::string query_of(const api::Endpoint& endpoint, unsigned way) {
  if (way == 4) return {};
  if (way == 5) return "format=cbor";
  if (way == 6) return "validate_only=true";
  if (endpoint.formats.empty()) return "view=chart";
  const auto& format = endpoint.formats[way % endpoint.formats.size()];
  auto query = "format=" + std::string(format.name);
  if (!format.views.empty())
    query += "&view=" + std::string(format.views[way / 7 % format.views.size()]);
  return query + (format.needs_speed ? "&speed_mm_min=600" : "");
}

/// Returns whether a number requires more work than one input of a fuzzer may cost.
bool beyond(std::string_view name, const api::Json& value) {
  using Bound = std::pair<std::string_view, double>;
  static constexpr Bound kMost[] = {
      {"uniform_points", 720.0}, {"points", 720.0}, {"sections", 48.0}, {"positions", 8.0}};
  static constexpr Bound kLeast[] = {{"tolerance_mm", 1e-3}, {"step_mm", 0.1}, {"period_s", 1e-3},
                                     {"period_us", 2e3},     {"mm_min", 1e2},  {"pitch_deg", 0.5}};
  const auto* number = value.as<double>();
  if (number == nullptr) return false;
  const auto named = [&](const Bound& bound) { return bound.first == name; };
  const auto* most = std::ranges::find_if(kMost, named);
  const auto* least = std::ranges::find_if(kLeast, named);
  return (most != std::end(kMost) && *number > most->second) ||
         (least != std::end(kLeast) && *number < least->second);
}

bool costly(const api::Json& json) {
  if (const auto* array = json.as<api::Json::Array>()) return std::ranges::any_of(*array, costly);
  const auto* object = json.as<api::Json::Object>();
  if (object == nullptr) return false;
  const auto* mill = json.find("mill");  // whose positions are many by default
  return (mill != nullptr && json.find("positions") == nullptr) ||
         std::ranges::any_of(*object, [](const api::Json::Member& member) {
           return beyond(member.first, member.second) || costly(member.second);
         });
}

[[noreturn]] void broken(const char* promise, const std::string& body) {
  std::fprintf(stderr, "%s: %s\n", promise, body.substr(0, 2000).c_str());
  std::abort();
}

void check(const api::Outcome& outcome) {
  if (outcome.body.empty()) broken("an empty body", outcome.content_type);
  if (outcome.error == ErrorKind::internal) broken("a failure of ours", outcome.body);
  const bool json = outcome.content_type.find("json") != std::string::npos;
  if (json && !api::parse(outcome.body)) broken("not JSON", outcome.body);
}

void ask(std::string_view path, std::string_view query, const std::string& body,
         const api::Context& context) {
  if (const auto parsed = api::parse(body); parsed && costly(*parsed)) return;
  const api::Call call{.method = "POST",
                       .path = path,
                       .query = query,
                       .accept = {},
                       .content_type = "application/json",
                       .body = body,
                       .job_id = {},
                       .request_id = "fuzz"};
  check(api::dispatch(call, context));
}

void ask_line(const std::string& text, const api::Context& context) {
  const auto line = api::read_batch_line(text, "fuzz", context);
  const std::string answer = line.error ? line.problem : "{}";
  if (!api::parse(answer)) broken("not JSON", answer);
  if (line.error.has_value() == line.code.empty()) broken("an error without its code", answer);
  const auto printed = api::print_batch_line(line, 1, {.status = 200, .content = answer});
  if (!api::parse(printed.substr(0, printed.find('\n'))))
    broken("a line that is not JSON", printed);
  if (!line.error) ask(line.path, line.query, line.body, context);
}

}  // namespace

std::string_view endpoint_of(std::span<const std::uint8_t> bytes) {
  return bytes.empty() || bytes.size() > kLongest ? std::string_view{} : id_at(bytes[0]);
}

void dispatch_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > kLongest) return;
  const api::Context context{.clock = {}, .status = [](ErrorKind) { return 400; }};
  const std::string body(bytes.begin() + 1, bytes.end());
  if (id_at(bytes[0]) == api::kBatchesId) return ask_line(body, context);
  if (const auto* endpoint = endpoint_of_id(id_at(bytes[0])))
    ask(endpoint->path, query_of(*endpoint, bytes[0] >> 4u), body, context);
}

}  // namespace tubecut::fuzz
