#include "server/admin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "api/api.hpp"
#include "server/observe/metrics.hpp"

namespace tubecut::server {
namespace {

Response ask(std::string_view method, std::string_view target, bool ready = true) {
  return admin(
      {.method = std::string(method), .target = std::string(target)},
      {.ready = [ready] { return ready; }, .metrics = [] { return std::string("m 1\n"); }});
}

TEST(Admin, Probes) {
  EXPECT_EQ(ask("GET", "/livez", false).status, 200);
  EXPECT_EQ(ask("GET", "/readyz", true).status, 200);
  EXPECT_EQ(ask("GET", "/readyz", false).status, 503);
  EXPECT_EQ(ask("HEAD", "/readyz?verbose", true).status, 200);
  EXPECT_EQ(ask("GET", "/metrics").body, "m 1\n");
}

TEST(Admin, RefusesTheRestAsProblems) {
  EXPECT_EQ(ask("GET", "/v1/version").status, 404);
  const auto response = ask("POST", "/livez");
  EXPECT_EQ(response.status, 405);
  EXPECT_EQ(header(response.headers, "Allow"), "GET, HEAD");
  EXPECT_EQ(response.content_type, "application/problem+json");
}

TEST(Admin, AnswersOnlyToItsNamesIfTheyAreSet) {
  const auto status = [](const char* host, const Hosts& hosts) {
    return admin({.method = "GET", .target = "/metrics", .headers = {{"Host", host}}},
                 {.ready = [] { return true; },
                  .metrics = [] { return std::string("m 1\n"); },
                  .hosts = hosts})
        .status;
  };
  EXPECT_EQ(status("localhost:9090", Hosts{{"cell-3.plant.example"}}), 200);
  EXPECT_EQ(status("", Hosts{{"cell-3.plant.example"}}), 200);
  EXPECT_EQ(status("evil.example", Hosts{{"cell-3.plant.example"}}), 400);
  EXPECT_EQ(status("evil.example", std::nullopt), 200);
}

TEST(Metrics, CountEveryOutcome) {
  std::uint64_t drops = 0;
  Metrics metrics({.log_drops = [&] { return drops; },
                   .ready = [] { return true; },
                   .transport =
                       [] {
                         return TransportStats{
                             .waiting = 7, .busy = 1, .slots = 2, .refused_queue = 9, .hung_up = 3};
                       }});
  JobRecord job;
  job.method = "POST";
  job.facts.verdict = "ok";
  job.facts.endpoint = "bevel-tables";
  job.facts.stages = {{"compute", 0.25}};
  job.status = 200;
  job.seconds = 0.003;
  metrics.started();
  metrics.started();
  metrics.finished(job);
  job.status = 500;
  job.facts.error_code = "verification_failed";
  metrics.finished(job);
  metrics.started();
  metrics.reload_failed("machines");
  drops = 4;
  const std::string text = metrics.text();
  for (const auto* line :
       {"http_server_request_duration_seconds_count{http_request_method=\"POST\",http_response_"
        "status_code=\"200\",http_route=\"/v1/bevel-tables\"} 1\n",
        "http_route=\"/v1/bevel-tables\",le=\"0.0025\"} 0\n",
        "http_route=\"/v1/bevel-tables\",le=\"0.005\"} 1\n",
        "tubecut_stage_duration_seconds_sum{endpoint=\"bevel-tables\",stage=\"compute\"} 0.5\n",
        "tubecut_jobs_total{endpoint=\"bevel-tables\",verdict=\"ok\"} 1\n",
        "tubecut_jobs_total{endpoint=\"bevel-tables\",verdict=\"refused\"} 1\n",
        "tubecut_verification_failures_total{endpoint=\"bevel-tables\"} 1\n",
        "http_server_active_requests 1\n",
        "tubecut_ready 1\n",
        "tubecut_slots 2\n",
        "tubecut_slots_busy 1\n",
        "tubecut_queue_depth 7\n",
        "tubecut_numerics_info 11\n",
        "tubecut_refused_total{reason=\"queue_full\"} 9\n",
        "tubecut_clients_hung_up_total 3\n",
        "tubecut_log_lines_dropped_total 4\n",
        "tubecut_build_info{",
        "tubecut_reloads_failed_total{what=\"keys\"} 0\n",
        "tubecut_reloads_failed_total{what=\"machines\"} 1\n",
        "tubecut_reloads_failed_total{what=\"posts\"} 0\n",
        "tubecut_configuration_info{sha256=\"",
        "process_cpu_seconds_total 0.",
        "process_start_time_seconds 1",
        "process_open_fds ",
        "process_max_fds "}) {
    EXPECT_NE(text.find(line), text.npos) << line << text;
  }
}

int count(std::string_view text, std::string_view part) {
  int found = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Metrics, FailuresRiseFromZero) {
  std::set<std::string> endpoints = {"none"};
  for (const auto& example : api::examples()) endpoints.emplace(example.endpoint);
  ASSERT_GE(endpoints.size(), 11U);
  Metrics metrics({});
  const std::string fresh = metrics.text();
  for (const auto& endpoint : endpoints) {
    const std::string of = ",endpoint=\"" + endpoint + "\",http_response_status_code=";
    for (const auto& line :
         {"tubecut_verification_failures_total{endpoint=\"" + endpoint + "\"} 0\n",
          "tubecut_errors_total{code=\"verification_failed\"" + of + "\"500\"} 0\n",
          "tubecut_errors_total{code=\"not_converged\"" + of + "\"500\"} 0\n",
          "tubecut_errors_total{code=\"internal_error\"" + of + "\"500\"} 0\n",
          "tubecut_errors_total{code=\"unavailable\"" + of + "\"503\"} 0\n",
          "tubecut_errors_total{code=\"over_budget\"" + of + "\"504\"} 0\n"}) {
      EXPECT_NE(fresh.find(line), fresh.npos) << line;
    }
  }
  JobRecord job;
  job.status = 500;
  job.facts.endpoint = "holes";
  job.facts.error_code = "verification_failed";
  metrics.started();
  metrics.finished(job);
  const std::string text = metrics.text();
  for (const auto* name : {"tubecut_errors_total{", "tubecut_verification_failures_total{"}) {
    EXPECT_EQ(count(text, name), count(fresh, name)) << "the failure began a series of its own";
  }
}

TEST(Metrics, NumberIsBoundedForAnyRequests) {
  Metrics metrics({});
  const auto series = [&] {
    const auto text = metrics.text();
    return std::ranges::count(text, '\n');
  };
  JobRecord job;
  job.method = "BREW";
  job.status = 405;
  metrics.started();
  metrics.finished(job);
  const auto before = series();
  for (int i = 0; i < 1000; ++i) {
    job.method = "M" + std::to_string(i);
    job.facts.id = job.request_id = job.client = job.identity = job.method;
    metrics.started();
    metrics.finished(job);
  }
  EXPECT_EQ(series(), before);
}

}  // namespace
}  // namespace tubecut::server
