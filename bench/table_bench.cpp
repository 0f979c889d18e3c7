// Microseconds of Table 1's parts, compared with a plain program of the same formulas.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "bench/baseline.hpp"
#include "bench/table_1.hpp"
#include "core/bevel/table/angles.hpp"
#include "core/joint/stations.hpp"

namespace tubecut {
namespace {

bevel::AngleProfile profile() {
  const auto table = bevel::table(table_1_spec(false)).value();
  bevel::AngleProfile out{.s = table.developed, .b = {}, .period = table.developed_total};
  for (std::size_t i = 0; i < table.b.size(); ++i)
    out.b.push_back(std::max(table.b_raw[i], table.b_required[i]));
  return out;
}

/// Table 1 as the plain program has it.
baseline::End plain_end() {
  const auto target = table_1_spec(false).target;
  baseline::End out{target.outer_radius, target.wall, {}};
  for (const auto& n : kTable1)
    out.partners.push_back({n[0], n[1] * kRadPerDeg, n[2] * kRadPerDeg, n[3], 0.0});
  return out;
}
constexpr baseline::Limits kPlainLimits{5.0 * kRadPerDeg, 1.0 * kRadPerDeg};

void baseline_contour_360(benchmark::State& state) {
  const auto end = plain_end();
  for (auto _ : state) benchmark::DoNotOptimize(baseline::contour(end.partners, 30.0, 360));
}
BENCHMARK(baseline_contour_360)->Unit(benchmark::kMicrosecond);

void baseline_angles_360(benchmark::State& state) {
  const auto end = plain_end();
  for (auto _ : state)
    benchmark::DoNotOptimize(baseline::contour_with_angles(end.partners, 30.0, 360));
}
BENCHMARK(baseline_angles_360)->Unit(benchmark::kMicrosecond);

/// Both programs must have the same numbers to be compared.
double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = a.size() == b.size() ? 0.0 : 1.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

void baseline_table(benchmark::State& state) {
  const auto end = plain_end();
  const auto plain = baseline::table(end, kPlainLimits, 360);
  const auto ours = bevel::table(table_1_spec(false)).value();
  const double off =
      std::max({apart(plain.angles.at.z, ours.z_inner), apart(plain.b, ours.b),
                apart(plain.required, ours.b_required), apart(plain.z_outer, ours.z_outer)});
  if (!(off < 1e-9)) state.SkipWithError("the plain program has other numbers");
  for (auto _ : state) benchmark::DoNotOptimize(baseline::table(end, kPlainLimits, 360));
}
BENCHMARK(baseline_table)->Unit(benchmark::kMicrosecond);

void baseline_bytes(benchmark::State& state) {
  const auto table = baseline::table(plain_end(), kPlainLimits, 360);
  for (auto _ : state) benchmark::DoNotOptimize(baseline::json(table));
}
BENCHMARK(baseline_bytes)->Unit(benchmark::kMicrosecond);

void trace_with_events(benchmark::State& state) {
  const auto cutters = joint::resolve(table_1()).value();
  for (auto _ : state) benchmark::DoNotOptimize(joint::trace(cutters, 30.0));
}
BENCHMARK(trace_with_events)->Unit(benchmark::kMicrosecond);

std::vector<double> phases_360() {
  std::vector<double> out(360);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = kTwoPi * static_cast<double>(i) / 360.0;
  return out;
}

void contour_360(benchmark::State& state) {
  const auto contour = joint::trace(joint::resolve(table_1()).value(), 30.0).value();
  const auto phases = phases_360();
  for (auto _ : state)
    benchmark::DoNotOptimize(joint::contacts_at(contour, joint::stations_at(30.0, phases), phases));
}
BENCHMARK(contour_360)->Unit(benchmark::kMicrosecond);

void angles_360(benchmark::State& state) {
  const auto contour = joint::trace(joint::resolve(table_1()).value(), 30.0).value();
  const auto phases = phases_360();
  const bevel::Rule rule(bevel::HalfDihedral{}, bevel::Dihedral::weld_side);
  for (auto _ : state) {
    const auto stations = joint::stations_at(30.0, phases);
    const auto contacts = joint::contacts_at(contour, stations, phases);
    std::vector<bevel::Angles> angles(phases.size());
    rule.angles(joint::normals_at(contour.cutters, stations, contacts.cutter), angles);
    benchmark::DoNotOptimize(angles);
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
  const auto request = table_1_spec(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(bevel::table(request));
}
BENCHMARK(whole_table)->ArgName("refine")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void whole_table_with_kerf(benchmark::State& state) {
  auto request = table_1_spec(false);
  request.kerf = 1.5;
  for (auto _ : state) benchmark::DoNotOptimize(bevel::table(request));
}
BENCHMARK(whole_table_with_kerf)->Unit(benchmark::kMicrosecond);

void verify_table(benchmark::State& state) {
  const auto request = table_1_spec(true);
  const auto table = bevel::table(request).value();
  for (auto _ : state) benchmark::DoNotOptimize(bevel::verify(request, table));
}
BENCHMARK(verify_table)->Unit(benchmark::kMicrosecond);

/// Additional options of jobs: a tolerance, a kerf.
void table_job(benchmark::State& state) {
  auto request = table_1_spec(true);
  if (state.range(0) != 0) request.sampling = {.tolerance = joint::Tolerance{0.05}};
  request.kerf = 0.1 * static_cast<double>(state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(bevel::table(request));
}
BENCHMARK(table_job)
    ->ArgNames({"tolerance", "kerf_tenths"})
    ->ArgsProduct({{0, 1}, {0, 15}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tubecut

BENCHMARK_MAIN();
