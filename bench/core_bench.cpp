// Microseconds of core: Table 1's parts, a feed curve, a groove and its mill path, a pulse
// schedule.
#include <benchmark/benchmark.h>

#include "core/bevel/required.hpp"
#include "core/bevel/table.hpp"
#include "core/cutoff/feed_curve.hpp"
#include "core/cutoff/verify.hpp"
#include "core/groove/groove.hpp"
#include "core/groove/mill_path.hpp"
#include "core/motion/replay.hpp"

namespace tubecut {
namespace {

/// Source 000, Table 1.
std::vector<joint::Partner> table_1() {
  const double numbers[][4] = {
      {55, 85, 0, 0}, {35, 65, 90, 15}, {35, 35, 245, -5}, {35, 55, 320, 0}};
  std::vector<joint::Partner> out;
  for (const auto& n : numbers)
    out.emplace_back(joint::TubeCutter{.radius = n[0],
                                       .inclination = Angle::deg(n[1]),
                                       .clocking = Angle::deg(n[2]),
                                       .offset = n[3]});
  return out;
}

bevel::TableSpec spec(bool refine) {
  const bevel::BevelRateLimits limits{.slope = 5.0 * kRadPerDeg, .curvature = 1.0 * kRadPerDeg};
  return {.target = {.outer_radius = 35, .wall = 5},
          .partners = table_1(),
          .sampling = {.uniform_points = 360},
          .groove = bevel::HalfDihedral{},
          .smoothing = bevel::EnvelopeSmoothing{.limits = limits, .refine = refine}};
}

bevel::AngleProfile profile() {
  const auto table = bevel::table(spec(false)).value();
  bevel::AngleProfile out{.s = table.developed, .b = {}, .period = table.developed_total};
  for (std::size_t i = 0; i < table.b.size(); ++i)
    out.b.push_back(std::max(table.b_raw[i], table.b_required[i]));
  return out;
}

void trace_with_events(benchmark::State& state) {
  const auto cutters = joint::resolve(table_1()).value();
  for (auto _ : state) benchmark::DoNotOptimize(joint::trace(cutters, 30.0));
}
BENCHMARK(trace_with_events)->Unit(benchmark::kMicrosecond);

void contour_360(benchmark::State& state) {
  const auto contour = joint::trace(joint::resolve(table_1()).value(), 30.0).value();
  for (auto _ : state)
    for (int i = 0; i < 360; ++i)
      benchmark::DoNotOptimize(joint::contact_at(contour, kTwoPi * i / 360.0));
}
BENCHMARK(contour_360)->Unit(benchmark::kMicrosecond);

void angles_360(benchmark::State& state) {
  const auto contour = joint::trace(joint::resolve(table_1()).value(), 30.0).value();
  const bevel::Rule rule(bevel::HalfDihedral{}, bevel::Dihedral::weld_side);
  for (auto _ : state)
    for (int i = 0; i < 360; ++i) {
      const double phi = kTwoPi * i / 360.0;
      const auto cutter = joint::contact_at(contour, phi).cutter;
      const auto hit =
          joint::continued_hit(contour.cutters[cutter], joint::generator_at(30.0, phi));
      benchmark::DoNotOptimize(rule.angles(hit.normal));
    }
}
BENCHMARK(angles_360)->Unit(benchmark::kMicrosecond);

void envelope_360(benchmark::State& state) {
  const auto input = profile();
  const bevel::EnvelopeSpec method{.limits = {5.0 * kRadPerDeg, 1.0 * kRadPerDeg},
                                   .refine = state.range(0) != 0};
  for (auto _ : state) benchmark::DoNotOptimize(bevel::envelope(input, method));
}
BENCHMARK(envelope_360)->ArgName("refine")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void hermite_360(benchmark::State& state) {
  const auto input = profile();
  for (auto _ : state)
    benchmark::DoNotOptimize(bevel::hermite(input, {.limit = 10.0 * kRadPerDeg, .transition = 15}));
}
BENCHMARK(hermite_360)->Unit(benchmark::kMicrosecond);

void whole_table(benchmark::State& state) {
  const auto request = spec(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(bevel::table(request));
}
BENCHMARK(whole_table)->ArgName("refine")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void verify_table(benchmark::State& state) {
  const auto request = spec(true);
  const auto table = bevel::table(request).value();
  for (auto _ : state) benchmark::DoNotOptimize(bevel::verify(request, table));
}
BENCHMARK(verify_table)->Unit(benchmark::kMicrosecond);

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

/// One optimised position, the two methods side by side: their ratio is what the certificate costs,
/// or saves.
void mill_position(benchmark::State& state) {
  const auto method = state.range(0) != 0 ? groove::Method::annealing : groove::Method::chebyshev;
  const auto request = mill_spec(90, method);
  const auto joint = groove::joint_of(request.groove).value();
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
  const auto table = bevel::table(spec(true)).value();
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
