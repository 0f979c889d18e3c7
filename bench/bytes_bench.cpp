// Times of printing: a table's numbers, its columns, its answer with the hash, only the hash.

#include <benchmark/benchmark.h>

#include <charconv>
#include <random>
#include <string>
#include <vector>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/wire/sha256.hpp"
#include "api/wire/shortest.hpp"
#include "api/wire/writer.hpp"
#include "core/bevel/table/table.hpp"

namespace tubecut {
namespace {

/// Source 000, Table 1.
bevel::TableSpec table_1() {
  const double numbers[][4] = {
      {55, 85, 0, 0}, {35, 65, 90, 15}, {35, 35, 245, -5}, {35, 55, 320, 0}};
  bevel::TableSpec out{.target = {.outer_radius = 35, .wall = 5},
                       .sampling = {.uniform_points = 360},
                       .groove = bevel::HalfDihedral{},
                       .smoothing = bevel::NoSmoothing{}};
  for (const auto& n : numbers)
    out.partners.emplace_back(joint::TubeCutter{.radius = n[0],
                                                .inclination = Angle::deg(n[1]),
                                                .clocking = Angle::deg(n[2]),
                                                .offset = n[3]});
  return out;
}

std::vector<double> of_a_table() {
  std::mt19937_64 draw(18);
  std::uniform_real_distribution<double> number(-180.0, 360.0);
  std::vector<double> out(6'480);
  for (auto& one : out) one = number(draw);
  return out;
}

template <class F>
void print_numbers(benchmark::State& state, F print) {
  const auto numbers = of_a_table();
  std::vector<char> text(numbers.size() * api::kShortestBytes + api::kShortestBytes);
  for (auto _ : state) {
    char* to = text.data();
    for (const double number : numbers) to = print(to, number);
    benchmark::DoNotOptimize(to);
  }
}
void numbers_shortest(benchmark::State& state) { print_numbers(state, api::print_shortest); }
BENCHMARK(numbers_shortest)->Unit(benchmark::kMicrosecond);
void numbers_by_library(benchmark::State& state) {
  print_numbers(state, [](char* to, double number) {
    return std::to_chars(to, to + api::kShortestBytes, number).ptr;
  });
}
BENCHMARK(numbers_by_library)->Unit(benchmark::kMicrosecond);

/// `columns` 0: all of them.
void encode_and_hash(benchmark::State& state) {
  const auto spec = table_1();
  const auto table = bevel::table(spec).value();
  const std::vector<std::string> four{"phi_deg", "z_inner_mm", "z_outer_mm", "b_deg"};
  const auto columns = state.range(0) == 0 ? std::vector<std::string>{} : four;
  std::size_t bytes = 0;
  for (auto _ : state) {
    api::Writer out(1 << 16);
    out.object([&](api::Writer& w) { api::encode_table(spec, table, columns, w); });
    benchmark::DoNotOptimize(out.sha256());
    bytes = out.take().size();
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(encode_and_hash)->ArgName("columns")->Arg(0)->Arg(4)->Unit(benchmark::kMicrosecond);

void hash(benchmark::State& state) {
  const std::string text(104'000, '7');
  for (auto _ : state) benchmark::DoNotOptimize(api::sha256(text));
}
BENCHMARK(hash)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tubecut

BENCHMARK_MAIN();
