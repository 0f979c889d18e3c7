// Trusses of 10 to 10 000 members: only core, and the whole request through the api. Time and
// memory are linear in the members: the fitted order, and the most bytes in use per member.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <string>

#include "api/api.hpp"
#include "core/joint/node/node.hpp"

namespace {

/// Bytes in use now and at most, of everything allocated by `new`. One thread.
struct Heap {
  std::size_t live = 0, most = 0;
};
Heap heap;

void* take(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  heap.live += malloc_usable_size(block);
  heap.most = std::max(heap.most, heap.live);
  return block;
}
void give(void* block) {
  if (block != nullptr) heap.live -= malloc_usable_size(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return take(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t align) {
  const auto unit = static_cast<std::size_t>(align);
  return take(std::aligned_alloc(unit, (size + unit - 1) / unit * unit));
}
void operator delete(void* block) noexcept { give(block); }
void operator delete(void* block, std::size_t) noexcept { give(block); }
void operator delete(void* block, std::align_val_t) noexcept { give(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { give(block); }

namespace tubecut {
namespace {

/// The peak of a run's bytes above the level before, divided by its members.
class PeakPerMember {
 public:
  explicit PeakPerMember(benchmark::State& state) : state_(state), before_(heap.live) {
    heap.most = heap.live;
  }
  ~PeakPerMember() {
    const auto peak = static_cast<double>(heap.most - before_);
    state_.counters["peak_bytes"] = peak;
    state_.counters["peak_bytes_per_member"] = peak / static_cast<double>(state_.range(0));
  }
  PeakPerMember(const PeakPerMember&) = delete;
  PeakPerMember& operator=(const PeakPerMember&) = delete;

 private:
  benchmark::State& state_;
  std::size_t before_;
};

constexpr double kPanel = 2000.0;
constexpr double kHeight = 1800.0;

constexpr std::int64_t kRow = 400;  // members of one truss; the next is placed next to it

/// Trusses of two chords and the braces between them.
joint::NodeSpec truss(std::int64_t count) {
  joint::NodeSpec out;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t place = i % kRow;
    const double y = 6'000.0 * static_cast<double>(i / kRow);
    const auto brace = place - 2;
    const double x = kPanel * static_cast<double>(brace / 2);
    joint::Member m{.outer_radius = 109.55, .wall = 8, .name = "M" + std::to_string(i)};
    if (place < 2) {
      m.start = {-500, y, kHeight * static_cast<double>(place)};
      m.finish = {kPanel * static_cast<double>(kRow / 2), y, m.start.z()};
    } else {
      m.start = {brace % 2 == 0 ? x : x + kPanel, y + 6, 0};
      m.finish = {x + kPanel / 2, y + 6, kHeight};
      m.outer_radius = 44.45;
      m.priority = 1;
    }
    out.members.push_back(std::move(m));
  }
  out.connect = joint::Within{20.0};
  return out;
}

std::string body(const joint::NodeSpec& spec) {
  const auto point = [](const Eigen::Vector3d& p) {
    return "[" + std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z()) +
           "]";
  };
  std::string out = "{\"connect\":{\"within_mm\":20},\"members\":[";
  for (const auto& m : spec.members)
    out += (out.back() == '[' ? "" : ",") + ("{\"id\":\"" + m.name) +
           "\",\"start_mm\":" + point(m.start) + ",\"end_mm\":" + point(m.finish) +
           ",\"outer_diameter_mm\":" + std::to_string(2 * m.outer_radius) +
           ",\"wall_mm\":" + std::to_string(m.wall) +
           ",\"priority\":" + std::to_string(m.priority) + "}";
  return out + "]}";
}

void solve_truss(benchmark::State& state) {
  const auto spec = truss(state.range(0));
  const PeakPerMember peak(state);
  for (auto _ : state) benchmark::DoNotOptimize(joint::solve(spec));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(solve_truss)
    ->RangeMultiplier(10)
    ->Range(10, 10'000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

void post_truss(benchmark::State& state) {
  const auto text = body(truss(state.range(0)));
  const api::Call call{.method = "POST",
                       .path = "/v1/nodes",
                       .query = {},
                       .accept = {},
                       .content_type = "application/json",
                       .body = text,
                       .job_id = {},
                       .request_id = "bench"};
  const PeakPerMember peak(state);
  for (auto _ : state) {
    const auto out = api::dispatch(call, {});
    if (out.error) state.SkipWithError(out.body.substr(0, 200).c_str());
    state.counters["answer_bytes"] = static_cast<double>(out.body.size());
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(post_truss)
    ->RangeMultiplier(10)
    ->Range(10, 10'000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace tubecut

BENCHMARK_MAIN();
