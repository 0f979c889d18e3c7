// Microseconds of core: Table 1's parts, and the feed curve of the 194 mm machine.
#include <benchmark/benchmark.h>

#include "core/bevel/required.hpp"
#include "core/bevel/table.hpp"
#include "core/cutoff/feed_curve.hpp"
#include "core/cutoff/verify.hpp"

namespace tubecut {
namespace {

/// Source 000, Table 1.
std::vector<joint::Partner> table_1() {
  const double numbers[][4] = {{55, 85, 0, 0}, {35, 65, 90, 15}, {35, 35, 245, -5}, {35, 55, 320, 0}};
  std::vector<joint::Partner> out;
  for (const auto& n : numbers)
    out.emplace_back(joint::TubeCutter{.radius = n[0], .inclination = Angle::deg(n[1]),
                                       .clocking = Angle::deg(n[2]), .offset = n[3]});
  return out;
}

bevel::TableSpec spec(bool refine) {
  const bevel::SwingLimits limits{.slope = 5.0 * kRadPerDeg, .curvature = 1.0 * kRadPerDeg};
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
      const auto hit = joint::continued_hit(contour.cutters[cutter], joint::generator_at(30.0, phi));
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
  out.linkage = {.arm = 430, .pivot_distance = 340, .pivot_offset = 90, .rest_angle = Angle::rad(1.3),
                 .slot_angle = Angle::rad(1.69), .rad_per_mm = 0.000486};
  out.cut = {.range = cutoff::CutDistances{.clearance = 12, .slowdown = 2, .wall = 10, .overcut = 3}, .feed = 1};
  out.fit.degree = degree;
  out.cycle = cutoff::CycleSpec{.period = 0.001, .max_cylinder_speed = 150,
                                .max_cylinder_acceleration = 800, .max_cylinder_jerk = 20'000};
  return out;
}

void feed_curve_400_points_cycle_1_ms(benchmark::State& state) {
  const auto request = feed_spec(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(cutoff::feed_curve(request));
}
BENCHMARK(feed_curve_400_points_cycle_1_ms)->ArgName("degree")->DenseRange(2, 5)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tubecut

BENCHMARK_MAIN();
