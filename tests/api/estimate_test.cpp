// Estimates the CPU of a job from only its request. bench/estimates compares it with measured CPU.

#include <gtest/gtest.h>

#include <stop_token>

#include "api/endpoint.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

Json object(Json::Object members) { return Json{std::move(members)}; }
Json points(double n) { return object({{"uniform_points", Json{n}}}); }

/// Of the square contour's 36 points: one, or each other than its neighbours.
Json bevels(double each) {
  Json::Array out;
  for (int i = 0; i < 36; ++i) out.emplace_back(i % 2 == 0 ? 0.0 : each);
  return Json{std::move(out)};
}

/// Cancelled after this number of stages.
Posted stopped(const std::string& endpoint, const std::string& body, int stages) {
  std::stop_source source;
  int laps = 0;
  const auto path = "/v1/" + endpoint;
  const api::Call call{.method = "POST",
                       .path = path,
                       .query = {},
                       .accept = {},
                       .content_type = "application/json",
                       .body = body,
                       .job_id = {},
                       .request_id = "test"};
  const api::Context context{.stop = source.get_token(),
                             .clock =
                                 [&] {
                                   if (++laps > stages) source.request_stop();
                                   return 0.0;
                                 },
                             .status = [](ErrorKind) { return 504; }};
  Posted out{api::dispatch(call, context), {}};
  out.body = *api::parse(out.outcome.body);
  return out;
}

/// Takes the estimate from a job that is cancelled before it begins, which already has it; a node
/// must be resolved first.
double estimate(const std::string& endpoint, const Json& body) {
  const auto late = stopped(endpoint, api::dump(body), 2);
  EXPECT_EQ(text(late.body, "code"), "over_budget") << endpoint << ": " << late.outcome.body;
  if (!at(late.body, "errors").as<Json::Array>()->empty()) return number(late.body, "errors/0/got");
  const auto dry = post("/v1/" + endpoint, api::dump(body), "validate_only=true");
  EXPECT_FALSE(dry.outcome.error) << endpoint << ": " << dry.outcome.body.substr(0, 300);
  return dry.outcome.error ? 0.0 : number(dry.body, "estimate/cpu_s");
}

TEST(Estimate, ComesOnlyWithValidateOnly) {
  for (const auto& endpoint : api::endpoints())
    for (const auto& example : api::examples()) {
      if (example.endpoint != endpoint.id || example.name.find('/') != std::string::npos) continue;
      const auto dry = post(endpoint.path, example.body, "validate_only=true");
      ASSERT_FALSE(dry.outcome.error) << endpoint.id;
      EXPECT_GT(number(dry.body, "estimate/cpu_s"), 0.0) << endpoint.id;
      EXPECT_EQ(dry.outcome.body,
                post(endpoint.path, example.body, "validate_only=true").outcome.body);
      const auto whole = post(endpoint.path, example.body);
      EXPECT_EQ(whole.body.find("estimate"), nullptr) << endpoint.id;
      break;
    }
}

/// A request, the field to change, its new value, and the minimum factor of the estimate.
struct Growth {
  const char* example;
  const char* path;
  Json before, after;
  double times;
};

std::vector<Growth> growths() {
  const Json few{90.0}, chebyshev = object({{"method", Json{"chebyshev"}}}),
                        annealing = object({{"method", Json{"annealing"}}});
  return {
      {"intersections/source-000-table-1", "sampling", points(500), points(5'000), 3},
      {"intersections/source-000-table-1", "sampling", object({{"tolerance_mm", Json{0.1}}}),
       object({{"tolerance_mm", Json{1e-4}}}), 2},
      {"bevel-tables/source-000-table-1", "sampling", points(100), points(1'000), 1.5},
      {"holes/set-on-branch", "sampling", points(100), points(1'000), 1.5},
      {"holes/set-on-branch", "sampling", points(2'000), points(20'000), 15},  // within a kerf
      {"nodes/k-joint-with-tables", "sampling", points(100), points(1'000), 1.5},
      {"parts/chord-with-holes", "sampling", points(100), points(1'000), 1.5},
      {"frames/pipe-spool", "sampling", points(100), points(1'000), 1.5},
      {"pulse-schedules/square-cut-from-a-bare-contour", "motion/speed",
       object({{"mm_min", Json{3'000.0}}}), object({{"mm_min", Json{30.0}}}), 2},
      {"pulse-schedules/square-cut-from-a-bare-contour", "contour/b_deg", bevels(0.0), bevels(1.0),
       2},
      {"pulse-schedules/table-1-on-the-five-axis-cutter", "cut/sampling", points(100),
       points(2'000), 1.4},
      {"pulse-schedules/table-1-on-the-five-axis-cutter", "cut/target/outer_diameter_mm",
       Json{70.0}, Json{105.0}, 1.1},
      {"pulse-schedules/two-ends-and-four-holes-of-a-part", "part/sampling", points(100),
       points(2'000), 1.4},
      {"pulse-schedules/two-ends-and-four-holes-of-a-part", "motion/speed",
       object({{"mm_min", Json{3'000.0}}}), object({{"mm_min", Json{30.0}}}), 2},
      {"pulse-schedules/source-001-mill-path", "mill_path/positions", Json{24.0}, Json{2'000.0},
       1.5},
      {"feed-curves/cut-off-194-mm-whole-cycle", "cycle/period_s", Json{2e-3}, Json{2e-5}, 3},
      {"feed-curves/cut-off-194-mm-whole-cycle", "table", object({{"points", Json{400.0}}}),
       object({{"points", Json{20'000.0}}}), 1.1},
      {"feed-curves/cut-off-194-mm-whole-cycle", "comparison",
       object({{"first_degree", Json{2.0}}, {"last_degree", Json{2.0}}}),
       object({{"first_degree", Json{1.0}}, {"last_degree", Json{8.0}}}), 1.3},
      {"grooves/case-a-right-angle", "sections", Json{100.0}, Json{10'000.0}, 10},
      {"grooves/case-c-oblique-offset", "area_in", Json{"axial"}, Json{"normal"}, 2},
      {"mill-paths/case-a-end-up", "positions", few, Json{400.0}, 1.2},
      {"mill-paths/case-a-end-up", "check", object({{"points", Json{11.0}}}),
       object({{"points", Json{51.0}}}), 1.1},
      {"mill-paths/case-a-end-up", "check", object({{"pitch_deg", Json{1.0}}}),
       object({{"pitch_deg", Json{0.1}}}), 1.05},
      {"mill-paths/case-a-end-up", "optimise", chebyshev, annealing, 1.5},
  };
}

TEST(Estimate, GrowsWithTheRequest) {
  for (const auto& one : growths()) {
    const std::string file = one.example;
    const auto endpoint = file.substr(0, file.find('/'));
    const auto body = example(file + ".json");
    const double before = estimate(endpoint, with(body, one.path, one.before));
    const double after = estimate(endpoint, with(body, one.path, one.after));
    EXPECT_GT(after, one.times * before) << one.example << ", " << one.path;
  }
}

TEST(Estimate, OfAJobOverItsBudgetIsInTheProblem) {
  for (const auto& endpoint : api::endpoints()) {
    int told = 0;  // a node may not be resolved yet, so the work is not known yet
    for (const auto& example : api::examples()) {
      if (example.endpoint != endpoint.id || told > 0) continue;
      const std::string body(example.body);
      const auto late = stopped(std::string(endpoint.id), body, 2);
      ASSERT_EQ(text(late.body, "code"), "over_budget") << endpoint.id;
      if (at(late.body, "errors").as<Json::Array>()->empty()) continue;
      const auto dry = post(endpoint.path, body, "validate_only=true");
      EXPECT_EQ(number(late.body, "errors/0/got"), number(dry.body, "estimate/cpu_s"))
          << endpoint.id;
      EXPECT_EQ(number(late.body, "errors/0/limit"), endpoint.budget_s) << endpoint.id;
      EXPECT_EQ(text(late.body, "errors/0/unit"), "s");
      const auto early = stopped(std::string(endpoint.id), body, 0);
      ASSERT_EQ(text(early.body, "code"), "over_budget") << endpoint.id;
      EXPECT_TRUE(at(early.body, "errors").as<Json::Array>()->empty()) << "nothing was known yet";
      ++told;
    }
    const bool resolved_first = endpoint.id == "nodes" || endpoint.id == "frames";
    EXPECT_EQ(told, resolved_first ? 0 : 1) << endpoint.id;
  }
}

TEST(Estimate, IsReckonedByTheCostsThatLimitsShow) {
  const auto page = api::dispatch({.method = "GET",
                                   .path = "/v1/limits",
                                   .query = {},
                                   .accept = {},
                                   .content_type = {},
                                   .body = {},
                                   .job_id = {},
                                   .request_id = {}},
                                  {});
  const auto limits = *api::parse(page.body);
  EXPECT_EQ(at(limits, "costs").as<Json::Array>()->size(), api::kCosts.size());
  for (const auto* name : {"kerf_pairs_max", "near_pairs_max", "overlaps_max", "mill_samples_max",
                           "mill_triples_max", "mill_annealed_samples_max"})
    EXPECT_GT(number(limits, std::string("limits/") + name), 0.0) << name;
}

}  // namespace
}  // namespace tubecut::testing
