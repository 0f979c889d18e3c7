// Microseconds of core: a feed curve, a groove and its mill path, a pulse schedule.
#include <benchmark/benchmark.h>

#include "bench/table_1.hpp"
#include "core/cutoff/feed_curve.hpp"
#include "core/cutoff/verify.hpp"
#include "core/groove/groove.hpp"
#include "core/groove/mill_path.hpp"
#include "core/motion/replay/replay.hpp"

namespace tubecut {
namespace {

/// Source 004's second machine; limits and handling assumed.
cutoff::FeedCurveSpec feed_spec(int degree) {
  cutoff::FeedCurveSpec out;
  out.linkage = {.arm = 430,
                 .pivot_distance = 340,
                 .pivot_offset = 90,
                 .rest_angle = Angle::rad(1.3),
                 .slot_angle = Angle::rad(1.69),
                 .rad_per_mm = 0.000486};
  out.cut = {
      .range = cutoff::CutDistances{.clearance = 12, .slowdown = 2, .wall = 10, .overcut = 3},
      .feed = 1};
  out.fit.degree = degree;
  out.cycle = cutoff::CycleSpec{.period = 0.001,
                                .max_cylinder_speed = 150,
                                .max_cylinder_acceleration = 800,
                                .max_cylinder_jerk = 20'000};
  return out;
}

void feed_curve_400_points_cycle_1_ms(benchmark::State& state) {
  const auto request = feed_spec(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(cutoff::feed_curve(request));
}
BENCHMARK(feed_curve_400_points_cycle_1_ms)
    ->ArgName("degree")
    ->DenseRange(2, 5)
    ->Unit(benchmark::kMicrosecond);

/// Case A of docs/theory/grooves-and-milling.md.
groove::MillPathSpec mill_spec(int positions, groove::Method method) {
  groove::MillPathSpec out;
  out.groove = {.chord = {.outer_diameter = 300, .wall = 14},
                .branch = {.outer_diameter = 160, .wall = 12},
                .root_face = {.height = 4, .width = 2},
                .filler = groove::FillerArea{120}};
  out.mill = {.half_angle = Angle::deg(20), .tip_radius = 10, .length = 40};
  out.positions = positions;
  out.optimise.method = method;
  return out;
}

void groove_24_sections(benchmark::State& state) {
  const auto request = mill_spec(90, groove::Method::none).groove;
  for (auto _ : state) benchmark::DoNotOptimize(groove::groove(request));
}
BENCHMARK(groove_24_sections)->Unit(benchmark::kMicrosecond);

/// One optimised position, the two methods side by side: their ratio is the cost or saving of the
/// certificate.
void mill_position(benchmark::State& state) {
  const auto method = state.range(0) != 0 ? groove::Method::annealing : groove::Method::chebyshev;
  const auto request = mill_spec(90, method);
  const auto joint = groove::joint_geometry(request.groove).value();
  const groove::Cone cone(request.mill);
  const auto omega = Angle::deg(40);
  const auto near = groove::neighbourhood(joint, omega, request.check).value();
  const auto start = groove::initial_pose(joint, groove::section(joint, omega).value(),
                                          request.mill, request.setup);
  const groove::Task task{near, cone, request.setup, start, request.optimise.hold};
  for (auto _ : state) {
    if (method == groove::Method::annealing) {
      std::mt19937_64 random(1);
      benchmark::DoNotOptimize(groove::annealing(task, random, {}));
    } else {
      const auto initial = groove::gap(near, cone, start).value();
      benchmark::DoNotOptimize(groove::chebyshev(task, groove::Bias::centred, initial));
    }
  }
}
BENCHMARK(mill_position)->ArgName("annealing")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void mill_path_whole(benchmark::State& state) {
  const auto request = mill_spec(static_cast<int>(state.range(0)), groove::Method::chebyshev);
  for (auto _ : state) benchmark::DoNotOptimize(groove::mill_path(request));
}
BENCHMARK(mill_path_whole)->ArgName("positions")->Arg(90)->Arg(360)->Unit(benchmark::kMillisecond);

/// Table 1's smoothed cut on the five-axis cutter at 600 mm/min; the period in us.
motion::ScheduleSpec schedule_spec(double period_us) {
  const auto table = bevel::table(table_1_spec(true)).value();
  motion::ScheduleSpec out;
  motion::CutPath contour;
  contour.phi = table.phi;
  contour.z = table.torch_inner;
  contour.b = table.b;
  contour.beam = table.beam;
  contour.outer_radius = 35;
  contour.wall = 5;
  contour.surface = motion::Surface::inner;
  out.cut = contour;
  out.machine = motion::catalogue().front().machine;
  out.machine.period = period_us * 1e-6;
  out.motion.start.at = motion::Start::At::first_point;
  return out;
}

void schedule_table_1(benchmark::State& state) {
  const auto request = schedule_spec(static_cast<double>(state.range(0)));
  double cut = 0.0;
  for (auto _ : state) {
    const auto schedule = motion::schedule(request).value();
    cut = schedule.report.time;
    benchmark::DoNotOptimize(schedule);
  }
  state.counters["cut_s"] = cut;
}
BENCHMARK(schedule_table_1)
    ->ArgName("period_us")
    ->Arg(4000)
    ->Arg(1000)
    ->Unit(benchmark::kMicrosecond);

void replay_table_1(benchmark::State& state) {
  const auto request = schedule_spec(4000);
  const auto schedule = motion::schedule(request).value();
  for (auto _ : state) benchmark::DoNotOptimize(motion::verify(request, schedule));
}
BENCHMARK(replay_table_1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tubecut

BENCHMARK_MAIN();
