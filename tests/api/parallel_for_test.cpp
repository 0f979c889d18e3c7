// Who does the pieces of a job, and in which order, changes no byte of its
// answer.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

std::string body_with(const ParallelFor& parallel_for, std::string_view path,
                      std::string_view query, const Json& request) {
  const auto body = api::dump(request);
  const api::Call call{.method = "POST",
                       .path = path,
                       .query = query,
                       .accept = {},
                       .content_type = "application/json",
                       .body = body,
                       .job_id = {},
                       .request_id = "test"};
  api::Context context{.status = [](ErrorKind kind) { return 400 + static_cast<int>(kind); }};
  context.parallel_for = parallel_for;
  return api::dispatch(call, context).body;
}

void backwards(std::size_t count, const ParallelTask& task) {
  while (count-- > 0) task(count);
}

void at_once(std::size_t count, const ParallelTask& task) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) task(i);
  };
  std::vector<std::thread> others(3);
  for (auto& other : others) other = std::thread(work);
  work();
  for (auto& other : others) other.join();
}

/// Checks that there were many tasks at least once, because otherwise the rest would prove nothing.
void expect_same(std::string_view path, std::string_view query, const Json& request,
                 std::size_t least_tasks) {
  std::size_t most = 0;
  const auto alone = body_with(
      [&most](std::size_t count, const ParallelTask& task) {
        most = std::max(most, count);
        run_in_order(count, task);
      },
      path, query, request);
  EXPECT_GE(most, least_tasks) << path;
  EXPECT_EQ(alone, body_with(run_in_order, path, query, request));
  EXPECT_TRUE(alone == body_with(backwards, path, query, request)) << path << query;
  EXPECT_TRUE(alone == body_with(at_once, path, query, request)) << path << query;
}

TEST(ParallelFor, DoesNotChangeTheTablesOfANode) {
  const auto request = example("nodes/k-joint-with-tables.json");
  for (const auto* query : {"", "format=cbor"}) {
    expect_same("/v1/nodes", query, request, 2);
    expect_same("/v1/nodes", query,
                with(request, "tables/columns", Json{Json::Array{Json{"b_deg"}}}), 2);
  }
  const auto by_tolerance =
      with(request, "sampling", Json{Json::Object{{"tolerance_mm", Json{0.05}}}});
  expect_same("/v1/nodes", "", by_tolerance, 1);
}

TEST(ParallelFor, DoesNotChangeThePartsOfAFrame) {
  const auto request = example("frames/gate-with-rails-through-uprights.json");
  expect_same("/v1/frames", "", request, 3);
}

}  // namespace
}  // namespace tubecut::testing
