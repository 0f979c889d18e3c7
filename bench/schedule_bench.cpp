// A pulse schedule stage by stage, and its bytes in every encoding. Two jobs on the default
// five-axis cutter at 600 mm/min: Table 1 at 4 ms, a saddle of 60 s at 1 ms. `share` is the time
// over the cut's own duration.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "api/api.hpp"
#include "core/base/elementary.hpp"
#include "core/motion/schedule/schedule.hpp"
#include "core/motion/timing/plan.hpp"

namespace tubecut {
namespace {

std::string table_1(const std::string& rest) {
  return R"({"cut":{"target":{"outer_diameter_mm":70,"wall_mm":5},"cutters":[)"
         R"({"kind":"tube","outer_diameter_mm":110,"inclination_deg":85,"clocking_deg":0,"offset_mm":0},)"
         R"({"kind":"tube","outer_diameter_mm":70,"inclination_deg":65,"clocking_deg":90,"offset_mm":15},)"
         R"({"kind":"tube","outer_diameter_mm":70,"inclination_deg":35,"clocking_deg":245,"offset_mm":-5},)"
         R"({"kind":"tube","outer_diameter_mm":70,"inclination_deg":55,"clocking_deg":320,"offset_mm":0}],)" +
         rest;
}

std::string saddle(const std::string& rest) {
  return R"({"cut":{"target":{"outer_diameter_mm":190,"wall_mm":8},"cutters":[{"kind":"tube",)"
         R"("outer_diameter_mm":325,"inclination_deg":90,"clocking_deg":0,"offset_mm":0}],)" +
         rest;
}

std::string request(bool long_one) {
  const std::string axis = R"(,"n_max":800})";
  const std::string period = long_one ? "1000" : "4000";
  const std::string rest =
      R"("sampling":{"uniform_points":360},"root_surface":"inner","groove":{"rule":"half_dihedral"},)"
      R"("contact":"inner","kerf_mm":0,"smoothing":{"method":"envelope","limits":)"
      R"({"machine":"five_axis_cutter","speed_mm_min":600}}},"machine":{"type":"five_axis_cutter","period_us":)" +
      period +
      R"(,"b_positive":"outer_edge_into_part","pivot_length_mm":150,"axes":[)"
      R"({"name":"C","unit":"deg","pulses_per_turn":360000,"v_max":60,"a_max":300,"j_max":6000)" +
      axis +
      R"(,{"name":"Y","unit":"mm","pulses_per_unit":1000,"v_max":200,"a_max":1000,"j_max":20000)" +
      axis +
      R"(,{"name":"Z1","unit":"mm","pulses_per_unit":1000,"v_max":100,"a_max":800,"j_max":16000)" +
      axis +
      R"(,{"name":"B","unit":"deg","pulses_per_unit":1000,"v_max":45,"a_max":300,"j_max":6000)" +
      axis + R"(]},"motion":{"speed":{"mm_min":600}}})";
  return long_one ? saddle(rest) : table_1(rest);
}

/// A contour of the same kind in closed form, so that core's stages run separately.
motion::ScheduleSpec spec(bool long_one) {
  motion::ScheduleSpec out;
  motion::CutPath c;
  c.outer_radius = long_one ? 95.0 : 35.0;
  const double partner = long_one ? 162.5 : 36.0;
  for (int i = 0; i < 360; ++i) {
    const double phi = kTwoPi * i / 360.0;
    const auto [sin, cos] = elementary::sincos(phi);
    c.phi.push_back(phi);
    c.z.push_back(std::sqrt(partner * partner - c.outer_radius * c.outer_radius * sin * sin));
    c.b.push_back(0.5 * cos * cos);
  }
  out.cut = c;
  out.machine = motion::catalogue().front().machine;
  out.machine.period = long_one ? 0.001 : 0.004;
  return out;
}

struct Stages {
  motion::ScheduleSpec spec;
  motion::PreparedCut job;
  motion::Plan plan;
};

const Stages& stages(bool long_one) {
  static const auto make = [](bool which) {
    Stages out{spec(which), {}, {}};
    out.job = motion::prepare_cut(out.spec, {}).value();
    out.plan = motion::plan(out.job.course, {}, {}).value();
    return out;
  };
  static const Stages table = make(false), cut = make(true);
  return long_one ? cut : table;
}

void share_of_cut(benchmark::State& state, const Stages& s) {
  const double cut = static_cast<double>(s.plan.positions.size()) * s.spec.machine.period;
  state.counters["cut_s"] = cut;
  // seconds of an iteration over those of the cut
  state.counters["share"] = benchmark::Counter(
      cut, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void path(benchmark::State& state) {
  const auto& s = stages(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(motion::prepare_cut(s.spec, {}));
  share_of_cut(state, s);
}
BENCHMARK(path)->ArgName("60_s_at_1_ms")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void plan(benchmark::State& state) {
  const auto& s = stages(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(motion::plan(s.job.course, {}, {}));
  share_of_cut(state, s);
}
BENCHMARK(plan)->ArgName("60_s_at_1_ms")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void sample(benchmark::State& state) {
  const auto& s = stages(state.range(0) != 0);
  const auto periods = static_cast<std::int64_t>(s.plan.positions.size()) - 1;
  for (auto _ : state)
    benchmark::DoNotOptimize(motion::sampled(s.plan.timing, s.job.course.limits.d, periods));
  share_of_cut(state, s);
}
BENCHMARK(sample)->ArgName("60_s_at_1_ms")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

/// Axis values and their rounding, all axes.
void pulses(benchmark::State& state) {
  const auto& s = stages(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(motion::pulses(s.job, s.plan));
  share_of_cut(state, s);
}
BENCHMARK(pulses)->ArgName("60_s_at_1_ms")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

/// The whole request, its replay and its bytes, as the service answers it.
void answer(benchmark::State& state, const char* media) {
  const auto body = request(state.range(0) != 0);
  const api::Call call{.method = "POST",
                       .path = "/v1/pulse-schedules",
                       .query = {},
                       .accept = media,
                       .content_type = "application/json",
                       .body = body,
                       .job_id = {},
                       .request_id = "bench"};
  const api::Context context{.clock = {}, .status = [](ErrorKind) { return 422; }};
  std::size_t bytes = 0;
  for (auto _ : state) {
    const auto out = api::dispatch(call, context);
    if (out.error) state.SkipWithError("refused");
    bytes = out.body.size();
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK_CAPTURE(answer, json, "application/json")
    ->ArgName("60_s_at_1_ms")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(answer, cbor, "application/cbor")
    ->ArgName("60_s_at_1_ms")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(answer, csv, "text/csv")
    ->ArgName("60_s_at_1_ms")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tubecut

BENCHMARK_MAIN();
