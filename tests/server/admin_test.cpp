#include "server/admin.hpp"

#include <gtest/gtest.h>

#include "server/metrics.hpp"

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

TEST(Metrics, CountWhatHappened) {
  std::uint64_t drops = 0;
  Metrics metrics([&] { return drops; }, [] { return true; });
  JobRecord job;
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
  drops = 4;
  const std::string text = metrics.text();
  for (const auto* line :
       {"tubecut_http_requests_total{endpoint=\"bevel-tables\",status=\"200\"} 1\n",
        "tubecut_http_requests_total{endpoint=\"bevel-tables\",status=\"500\"} 1\n",
        "tubecut_http_request_seconds_bucket{endpoint=\"bevel-tables\",status=\"200\",le=\"0."
        "0025\"} 0\n",
        "tubecut_http_request_seconds_bucket{endpoint=\"bevel-tables\",status=\"200\",le=\"0.005\"}"
        " 1\n",
        "tubecut_stage_seconds_total{endpoint=\"bevel-tables\",stage=\"compute\"} 0.5\n",
        "tubecut_verification_failures_total 1\n", "tubecut_in_flight 1\n", "tubecut_ready 1\n",
        "tubecut_log_lines_dropped_total 4\n", "tubecut_build_info{"}) {
    EXPECT_NE(text.find(line), text.npos) << line << text;
  }
}

}  // namespace
}  // namespace tubecut::server
