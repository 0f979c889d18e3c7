// Memory of jobs, counted by the program's own operator new: for their body within what is reserved
// for it, beyond it in proportion to their result, for the most expensive valid requests of every
// endpoint in every format and view; and never more than their grant.

#include "server/jobs/job_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <thread>

#include "api/api.hpp"
#include "api/endpoint.hpp"
#include "server/app.hpp"
#include "server/http/static_files.hpp"
#include "tests/support/call.hpp"
#include "tests/support/drawings.hpp"

namespace tubecut::testing {
namespace {

using api::Json;
using server::JobMemory;
using server::NoRoom;
using Grant = JobMemory::Grant;

constexpr std::size_t kPlenty = std::size_t{1} << 40;
constexpr std::size_t kSmallJob = 4u << 20;
/// Of a point, section, position, sample, row or period of a result, in the largest format: STEP.
constexpr std::size_t kMostPerItem = 12'000;

/// A request, and the number of its result's items.
struct Costly {
  std::string name;
  std::string endpoint;
  Json body;
  std::size_t items = 0;
};

Costly sampled(const std::string& file, std::size_t points) {
  return {file, file.substr(0, file.find('/')),
          with(example(file + ".json"), "sampling",
               Json{Json::Object{{"uniform_points", Json{static_cast<double>(points)}}}}),
          points};
}

Costly counted(const std::string& file, const std::string& field, std::size_t count) {
  return {file, file.substr(0, file.find('/')),
          with(example(file + ".json"), field, Json{static_cast<double>(count)}), count};
}

Json member(std::size_t i, bool chord) {
  const auto id = (chord ? "C" : "B") + std::to_string(i);
  const auto point = [](double x, double y, double z) {
    return Json{Json::Array{Json{x}, Json{y}, Json{z}}};
  };
  const double y = 400.0 * static_cast<double>(i);
  return Json{Json::Object{{"id", Json{id}},
                           {"start_mm", point(chord ? -500 : 0, y, 0)},
                           {"end_mm", point(chord ? 500 : 300, y, chord ? 0 : 400)},
                           {"outer_diameter_mm", Json{chord ? 219.1 : 114.3}},
                           {"wall_mm", Json{6.3}},
                           {"priority", Json{chord ? 0.0 : 1.0}}}};
}

/// `pairs` branches, each on a chord of its own; with tables of all branches' ends, or without.
Costly frame(std::size_t pairs, std::size_t points) {
  Json::Array members;
  for (std::size_t i = 0; i < pairs; ++i)
    for (const bool chord : {true, false}) members.push_back(member(i, chord));
  auto body = with(example("nodes/k-joint-with-tables.json"), "members", Json{std::move(members)});
  if (points == 0) {
    for (const auto* field : {"tables", "include", "sampling"})
      body = without(std::move(body), field);
    return {"a frame without tables", "nodes", std::move(body), 0};
  }
  body = with(std::move(body), "sampling",
              Json{Json::Object{{"uniform_points", Json{static_cast<double>(points)}}}});
  return {"a frame with tables", "nodes", std::move(body), pairs * points};
}

/// A square cut that pauses for `idle` additional periods.
Costly replay(std::size_t idle) {
  auto body = example("replays/square-cut.json");
  auto counts = at(body, "schedule/counts");
  for (auto& [name, column] : *counts.as<Json::Object>()) {
    auto& list = *column.as<Json::Array>();
    list.resize(list.size() + idle, Json{0.0});
  }
  return {"a replay", "replays", with(std::move(body), "schedule/counts", std::move(counts)), 0};
}

Costly bare_contour(std::size_t points) {
  auto body = example("pulse-schedules/square-cut-from-a-bare-contour.json");
  Json::Array phi, zero(points, Json{0.0});
  for (std::size_t i = 0; i < points; ++i)
    phi.emplace_back(std::floor(3.6e8 * static_cast<double>(i) / static_cast<double>(points)) /
                     1e6);
  body = with(std::move(body), "contour/phi_deg", Json{std::move(phi)});
  body = with(std::move(body), "contour/z_mm", Json{zero});
  return {"a contour of many points", "pulse-schedules",
          with(std::move(body), "contour/b_deg", Json{zero}), 0};
}

/// A slow schedule; its items are its periods.
Costly slow(const std::string& file, double mm_min) {
  auto body = with(example("pulse-schedules/" + file + ".json"), "motion/speed",
                   Json{Json::Object{{"mm_min", Json{mm_min}}}});
  const auto answer = post("/v1/pulse-schedules", api::dump(body), "format=csv");
  const auto rows = std::count(answer.outcome.body.begin(), answer.outcome.body.end(), '\n');
  return {file, "pulse-schedules", std::move(body), static_cast<std::size_t>(rows)};
}

/// A curve over a cycle of many samples.
Costly curve(double period_s) {
  auto body = with(example("feed-curves/cut-off-194-mm-whole-cycle.json"), "cycle/period_s",
                   Json{period_s});
  const auto answer = post("/v1/feed-curves", api::dump(body), "format=csv&view=samples");
  const auto rows = std::count(answer.outcome.body.begin(), answer.outcome.body.end(), '\n');
  return {"a cycle of many samples", "feed-curves", std::move(body),
          static_cast<std::size_t>(rows)};
}

/// A part with every end and every hole sampled so.
Costly part(const std::string& file, std::size_t points, std::size_t curves) {
  auto one = sampled("parts/" + file, points);
  one.items = points * curves;
  return one;
}

/// A frame with this number of ends and holes, each with this sampling.
Costly welded(const std::string& file, std::size_t points, std::size_t curves) {
  auto one = sampled("frames/" + file, points);
  one.items = points * curves;
  return one;
}

/// JSON whose values take the most memory for their bytes; no endpoint knows its fields.
Costly hoard(const std::string& endpoint, const std::string& item) {
  std::string text = "[" + item;
  while (text.size() < (256U << 10)) text += "," + item;
  return {"many times " + item, endpoint, Json{Json::Object{{"x", *api::parse(text + "]")}}}, 0};
}

std::vector<Costly> costliest() {
  constexpr std::size_t kMany = 3'000;
  std::vector<Costly> all{sampled("intersections/source-000-table-1", kMany),
                          sampled("intersections/two-tubes-by-axis", kMany),
                          counted("grooves/case-a-right-angle", "sections", kMany),
                          counted("grooves/case-b-near-equal-diameters", "sections", kMany),
                          counted("grooves/case-c-oblique-offset", "sections", kMany),
                          counted("mill-paths/case-a-end-up", "positions", 150),
                          counted("mill-paths/case-b-end-down", "positions", 150),
                          counted("feed-curves/cut-off-194-mm-whole-cycle", "table/points", 6'000),
                          curve(1e-4),
                          replay(50'000),
                          bare_contour(20'000),
                          slow("source-001-mill-path", 30.0),
                          slow("table-1-on-the-five-axis-cutter", 60.0),
                          slow("square-cut-from-a-bare-contour", 20.0),
                          slow("two-ends-and-four-holes-of-a-part", 150.0),
                          frame(500, 0),
                          frame(4, 3'000),
                          welded("jacket-node-with-set-in-stubs", 1'000, 7),
                          welded("roll-cage-of-12", 500, 24),
                          part("chord-with-holes", kMany, 2),
                          part("k-joint-brace", kMany, 1),
                          part("set-in-branch", kMany, 1),
                          part("table-1-with-a-square-far-end", kMany, 1)};
  for (const auto* file : {"source-000-table-1", "zones", "table-1-torch-45-deg", "mitre"})
    all.push_back(sampled(std::string("bevel-tables/") + file, kMany));
  for (const auto* file : {"set-in-branch", "set-on-branch", "through-brace"})
    all.push_back(sampled(std::string("holes/") + file, kMany));
  for (const auto& endpoint : api::endpoints())
    for (const auto* item : {"0", "[]", "\"\"", "{}", "{\"\":0}"})
      all.push_back(hoard(std::string(endpoint.id), item));
  return all;
}

/// Returns all formats and queries of an endpoint.
std::vector<std::pair<std::string, std::string>> ways(const api::Endpoint& endpoint) {
  std::vector<std::pair<std::string, std::string>> out{{"json", "format=json"},
                                                       {"cbor", "format=cbor"}};
  for (const auto& format : endpoint.formats) {
    const auto base =
        "format=" + std::string(format.name) + (format.needs_speed ? "&speed_mm_min=600" : "");
    if (format.views.empty()) out.emplace_back(format.name, base);
    for (const auto view : format.views)
      out.emplace_back(format.name, base + "&view=" + std::string(view));
  }
  return out;
}

struct Taken {
  int status = 0;
  std::size_t peak = 0;
};

Taken run(const server::App& app, const std::string& target, const std::string& body,
          std::size_t given = kPlenty) {
  const server::Request request{.method = "POST",
                                .target = target,
                                .headers = {{"Content-Type", "application/json"}},
                                .body = body};
  const JobMemory memory(given, [](std::size_t) { return Grant::in_use; });
  const auto response = app.handle(request);
  return {response.status, memory.peak()};
}

TEST(JobMemory, GrowsNoFasterThanBodyAndResult) {
  const server::App app({.budget = std::chrono::hours(1)});
  const bool print = std::getenv("TUBECUT_PRINT_MEMORY") != nullptr;
  // By default every format of every third request, and JSON of all.
  const int each = testing::drawings(3, 1);
  int index = 0;
  for (const auto& one : costliest()) {
    const bool whole = index++ % each == 0;
    const auto body = api::dump(one.body);
    for (const auto& endpoint : api::endpoints()) {
      if (endpoint.id != one.endpoint) continue;
      for (const auto& [format, query] : ways(endpoint)) {
        if (!whole && format != "json") continue;
        if (one.items == 0 && format != "json" && format != "cbor") continue;
        const auto most = kSmallJob + api::reserved_per_byte(endpoint.path) * body.size() +
                          kMostPerItem * one.items;
        const auto taken = run(app, std::string(endpoint.path) + "?" + query, body);
        EXPECT_LE(taken.peak, most) << one.name << ", " << query;
        if (one.items > 0) {
          EXPECT_EQ(taken.status, 200) << one.name << ", " << query;
        }
        if (print)
          std::printf(
              "%s %s %s: %d, %zu bytes in, %zu items, %.2f MiB, %.0f a byte, %.0f an item\n",
              one.endpoint.c_str(), one.name.c_str(), query.c_str(), taken.status, body.size(),
              one.items, static_cast<double>(taken.peak) / (1 << 20),
              static_cast<double>(taken.peak) / static_cast<double>(body.size()),
              static_cast<double>(taken.peak) /
                  static_cast<double>(std::max<std::size_t>(1, one.items)));
      }
    }
  }
}

TEST(JobMemory, ThrowsIfTheGrantIsRefused) {
  std::size_t asked = 0;
  JobMemory memory(10'000, [&](std::size_t bytes) {
    asked += bytes;
    return asked <= 4'000'000 ? Grant::given : Grant::in_use;
  });
  std::vector<std::unique_ptr<char[]>> held;
  bool ended = false;
  try {
    for (int i = 0; i < 10'000; ++i) held.push_back(std::make_unique<char[]>(1'000));
  } catch (const NoRoom& room) {
    ended = room.ever_fits;
  }
  EXPECT_TRUE(ended);
  EXPECT_GT(memory.peak(), 2'900'000U);
  EXPECT_LE(memory.peak(), 4'010'000U);
  held.clear();  // freed memory can be taken again
  EXPECT_NO_THROW(held.push_back(std::make_unique<char[]>(2'000'000)));
}

/// An allocator may bring forms of its own, which nobody would count.
TEST(JobMemory, CountsEveryFormOfNew) {
  constexpr std::size_t kBytes = 1'000'000;
  constexpr auto kUnit = std::align_val_t(64);
  const std::nothrow_t none;
  const JobMemory memory(kPlenty, [](std::size_t) { return Grant::never; });
  const auto live = [&memory] { return memory.taken().live; };
  const auto seen = [&](void* block, auto release) {
    EXPECT_TRUE(block != nullptr && live() >= kBytes);
    release(block);
    EXPECT_LT(live(), kBytes / 10);
  };
  seen(operator new(kBytes), [](void* b) { operator delete(b); });
  seen(operator new[](kBytes), [](void* b) { operator delete[](b); });
  seen(operator new(kBytes, none), [](void* b) { operator delete(b, std::nothrow); });
  seen(operator new[](kBytes, none), [](void* b) { operator delete[](b, std::nothrow); });
  seen(operator new(kBytes, kUnit), [](void* b) { operator delete(b, kUnit); });
  seen(operator new[](kBytes, kUnit), [](void* b) { operator delete[](b, kUnit); });
  seen(operator new(kBytes, kUnit, none), [](void* b) { operator delete(b, kUnit); });
  seen(operator new[](kBytes, kUnit, none), [](void* b) { operator delete[](b, kUnit); });
  seen(operator new(kBytes), [](void* b) { operator delete(b, kBytes); });
  seen(operator new[](kBytes), [](void* b) { operator delete[](b, kBytes); });
}

/// Pieces that another thread has made, and that this one frees.
TEST(JobMemory, TakesOverMemoryOfAnotherThread) {
  const JobMemory memory(10'000, [](std::size_t) { return Grant::in_use; });
  const auto live = [&memory] { return memory.taken().live; };
  std::unique_ptr<char[]> made;
  JobMemory::Taken taken;
  std::thread([&] {
    const JobMemory of_another(2'000'000, [](std::size_t) { return Grant::in_use; });
    made = std::make_unique<char[]>(1'000'000);
    taken = of_another.taken();
  }).join();
  EXPECT_LT(live(), 10'000U);
  JobMemory::take_over(taken);
  EXPECT_GE(live(), 1'000'000U);
  made = nullptr;
  EXPECT_LT(live(), 10'000U);
  EXPECT_NO_THROW(made = std::make_unique<char[]>(1'700'000));
  EXPECT_THROW(static_cast<void>(std::make_unique<char[]>(1'000'000)), NoRoom);
}

std::vector<Costly> everyday() {
  return {sampled("bevel-tables/zones", 720),
          sampled("holes/through-brace", 720),
          counted("grooves/case-a-right-angle", "sections", 720),
          frame(2, 180),
          replay(2'000),
          slow("square-cut-from-a-bare-contour", 500.0),
          curve(2e-3),
          sampled("parts/chord-with-holes", 360)};
}

/// Whatever is being computed or printed when memory ends: a refusal, not the end of the process.
TEST(JobMemory, EndsAJobWithARefusalAtAnyAllocation) {
  constexpr std::size_t kParts = 10;
  const server::App app({.budget = std::chrono::hours(1)});
  std::size_t refused = 0;
  for (const auto& one : everyday())
    for (const auto* way : {"cbor", "csv", "svg"}) {
      const auto target = "/v1/" + one.endpoint + "?format=" + way;
      const auto body = api::dump(one.body);
      static_cast<void>(run(app, target, body));  // because the first makes the lists of sizes
      const auto whole = run(app, target, body);
      if (whole.status != 200) continue;
      for (std::size_t part = 1; part < kParts; ++part) {
        const auto given = whole.peak * part / kParts;
        // The refusal itself needs some.
        const auto status = run(app, target, body, given + 50'000).status;
        EXPECT_TRUE(status == 429 || given + 50'000 >= whole.peak)
            << one.name << ", " << way << ", " << part << ": " << status;
        refused += status == 429 ? 1 : 0;
      }
    }
  EXPECT_GT(refused, 80U);
}

TEST(JobMemory, RefusesAFileOfTheConsoleThatItHasNoRoomToUnpack) {
  const auto files = server::static_files();
  if (files.empty()) GTEST_SKIP() << "built without the console";
  const auto& largest = *std::ranges::max_element(files, {}, &server::StaticFile::bytes);
  const server::App app({});
  const auto ask = [&](Grant grant) {
    const JobMemory memory(1u << 16, [=](std::size_t) { return grant; });
    return app.handle({.method = "GET", .target = std::string(largest.path)});
  };
  for (const auto& [grant, status] :
       {std::pair(Grant::in_use, 429), std::pair(Grant::never, 413)}) {
    const auto refused = ask(grant);
    EXPECT_EQ(refused.status, status);
    EXPECT_NE(refused.body.find("memory"), std::string::npos) << refused.body;
  }
  const auto unpacked = ask(Grant::given);
  EXPECT_EQ(unpacked.status, 200);
  EXPECT_EQ(unpacked.fixed.size(), largest.bytes);
  EXPECT_EQ(ask(Grant::in_use).status, 200) << "it is kept";
}

}  // namespace
}  // namespace tubecut::testing
