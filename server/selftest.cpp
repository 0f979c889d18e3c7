#include "server/selftest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "api/api.hpp"
#include "server/app.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

std::string result_of(const api::Example& example) {
  const std::string path = "/v1/" + std::string(example.endpoint);
  const auto outcome = api::dispatch({.method = "POST",
                                      .path = path,
                                      .query = {},
                                      .accept = {},
                                      .content_type = "application/json",
                                      .body = example.body,
                                      .job_id = {},
                                      .request_id = "selftest"},
                                     {.clock = {}, .status = status_of});
  return outcome.job.result_sha256.empty() ? outcome.job.error_code : outcome.job.result_sha256;
}

std::string fault_of(const KnownAnswer& known) {
  const auto all = api::examples();
  const auto at = std::ranges::find_if(all, [&](const api::Example& example) {
    return example.endpoint == known.endpoint && example.name == known.name;
  });
  const std::string got = at == all.end() ? "no such example" : result_of(*at);
  if (got == known.result_sha256) return {};
  return fmt::format("selftest: {}/{} gives {}, known is {}", known.endpoint, known.name, got,
                     known.result_sha256);
}

int print_all() {
  for (const auto& example : api::examples()) {
    fmt::print("    {{\"{}\", \"{}\",\n     \"{}\"}},\n", example.endpoint, example.name,
               result_of(example));
  }
  return 0;
}

}  // namespace

std::string selftest_fault(std::span<const KnownAnswer> known) {
  if (known.empty()) return "selftest: no answer is known";
  for (const auto& each : known) {
    if (auto fault = fault_of(each); !fault.empty()) return fault;
  }
  return {};
}

int selftest(bool all) {
  if (all) return print_all();
  int faults = 0;
  for (const auto& known : known_answers()) {
    const double start = steady_seconds();
    const auto fault = fault_of(known);
    const double ms = 1e3 * (steady_seconds() - start);
    fmt::print("{} {}/{} {:.1f} ms {}\n", fault.empty() ? "ok" : "DIFFERS", known.endpoint,
               known.name, ms, fault);
    faults += fault.empty() ? 0 : 1;
  }
  fmt::print("{} known answers, {} differ\n", known_answers().size(), faults);
  return faults == 0 ? 0 : 1;
}

}  // namespace tubecut::server
