#include "tests/fuzz/dispatch_bytes.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "api/api.hpp"
#include "api/endpoint.hpp"
#include "api/json.hpp"

namespace tubecut::fuzz {
namespace {

std::string query_of(const api::Endpoint& endpoint, unsigned way) {
  if (way == 4) return {};
  if (way == 5) return "format=cbor";
  if (way == 6) return "validate_only=true";
  if (endpoint.formats.empty()) return "view=chart";
  return "format=" + std::string(endpoint.formats[way % endpoint.formats.size()].name);
}

/// Numbers that ask for more work than one input of a fuzzer may cost.
bool costly(const api::Json& json) {
  if (const auto* array = json.as<api::Json::Array>()) {
    for (const auto& item : *array)
      if (costly(item)) return true;
  } else if (const auto* object = json.as<api::Json::Object>()) {
    for (const auto& [name, value] : *object) {
      const auto* number = value.as<double>();
      if (number != nullptr && (name == "uniform_points" || name == "points") && *number > 720.0)
        return true;
      if (number != nullptr &&
          (name == "tolerance_mm" || name == "step_mm" || name == "period_s") && *number < 1e-3)
        return true;
      if (costly(value)) return true;
    }
  }
  return false;
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

}  // namespace

void dispatch_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > kLongest) return;
  const auto& endpoint = api::endpoints()[(bytes[0] & 15u) % api::endpoints().size()];
  const auto query = query_of(endpoint, bytes[0] >> 4u);
  const std::string body(bytes.begin() + 1, bytes.end());
  if (const auto parsed = api::parse(body); parsed && costly(*parsed)) return;
  const api::Call call{.method = "POST",
                       .path = endpoint.path,
                       .query = query,
                       .accept = {},
                       .content_type = "application/json",
                       .body = body,
                       .job_id = {},
                       .request_id = "fuzz"};
  check(api::dispatch(call, {.stop = {}, .clock = {}, .status = [](ErrorKind) { return 400; }}));
}

}  // namespace tubecut::fuzz
