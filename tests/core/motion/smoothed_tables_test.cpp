// A table smoothed for a machine and a speed plans on that machine at that speed without a slow
// zone that the same contour with B held constant does not have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "core/bevel/table.hpp"
#include "core/motion/schedule.hpp"
#include "tests/core/joint/random_nodes.hpp"

namespace tubecut::motion::testing {
namespace {

constexpr int kNodes = 200;
constexpr std::uint64_t kSeed = 20260612;
constexpr double kSpeed = 10.0;  // mm/s
const double kUse = std::getenv("USE") ? std::atof(std::getenv("USE")) : 0.8;     // the default of a request

const Machine& machine() {
  static const Machine five = catalogue().front().machine;
  return five;
}

bevel::TableSpec random_table(std::mt19937_64& random, int n) {
  const auto node = joint::random_node(random, true, n % 3 == 0, false);
  bevel::TableSpec out;
  out.target = {.outer_radius = node.rho, .wall = 0.12 * node.rho};
  for (const auto& cutter : node.cutters)
    std::visit([&](const auto& one) { out.partners.emplace_back(one); }, cutter);
  if (n % 2 == 0) out.sampling.tolerance = joint::Tolerance{.value = 0.01};
  out.groove = bevel::HalfDihedral{};
  out.torch = {Angle::deg(-75), Angle::deg(75)};
  const Axis& swing = machine().axes.back();
  const auto limits = bevel::swing_limits(swing.v_max * kRadPerDeg, swing.a_max * kRadPerDeg,
                                          kSpeed, kUse);
  out.smoothing = bevel::EnvelopeSmoothing{
      .limits = *limits, .along = bevel::Along::length, .refine = false};
  return out;
}

Contour contour_of(const bevel::TableSpec& spec, const bevel::Table& table) {
  Contour out;
  out.phi = table.phi;
  out.z = table.torch_inner;
  out.b = table.b;
  out.outer_radius = spec.target.outer_radius;
  out.wall = spec.target.wall;
  out.surface = Surface::inner;
  if (!spec.sampling.tolerance || std::getenv("NOCORNER")) return out;
  out.corner.assign(out.phi.size(), false);
  for (const auto* events : {&table.inner_events, &table.outer_events})
    for (const auto& event : *events)
      for (std::size_t i = 0; i < out.phi.size(); ++i)
        if (out.phi[i] == event.phi) out.corner[i] = true;
  return out;
}

std::optional<Schedule> cut(const Contour& contour) {
  ScheduleSpec spec;
  spec.cut = contour;
  spec.machine = machine();
  spec.motion.speed = kSpeed;
  spec.motion.expert.optimism = 1.0;  // the slower, proven mode: one plan, and no less strict
  auto s = schedule(spec);
  if (!s) return std::nullopt;
  return *std::move(s);
}

bool meet(const SlowZone& a, const SlowZone& b) {
  constexpr double kNear = 0.02;  // rad: the ends of a zone move with its depth
  return a.phi_from <= b.phi_to + kNear && b.phi_from <= a.phi_to + kNear;
}

struct Figures {
  int planned = 0, zones = 0, added = 0;
  double slowest = 1.0;
};

void examine(const bevel::TableSpec& spec, int n, Figures& figures) {
  const auto table = bevel::table(spec);
  if (!table) return;
  Contour contour = contour_of(spec, *table);
  const auto swung = cut(contour);
  std::ranges::fill(contour.b, 0.0);
  const auto held = cut(contour);
  if (!swung || !held) return;
  ++figures.planned;
  for (const auto& zone : swung->report.slow) {
    ++figures.zones;
    const bool there = std::ranges::any_of(
        held->report.slow, [&](const SlowZone& other) { return meet(zone, other); });
    if (there) continue;
    ++figures.added;
    if (std::getenv("SHOW")) {
      std::cout << n << " zone " << zone.phi_from * kDegPerRad << ".." << zone.phi_to * kDegPerRad << " least " << zone.least_speed << " axis " << zone.axis << "\n";
      for (std::size_t i = 1; i + 1 < table->phi.size(); ++i)
        if (table->phi[i] > zone.phi_from - 0.06 && table->phi[i] < zone.phi_to + 0.06) {
          const double h0 = table->length[i] - table->length[i - 1], h1 = table->length[i + 1] - table->length[i];
          const double s0 = (table->b[i] - table->b[i-1]) / h0, s1 = (table->b[i+1] - table->b[i]) / h1;
          std::printf("  phi %9.4f len %9.4f z %9.4f b %8.3f slope %8.3f second %8.3f corner %d\n", table->phi[i] * kDegPerRad, table->length[i], contour.z[i], table->b[i] * kDegPerRad, s1 * kDegPerRad, (s1 - s0) / (0.5 * (h0 + h1)) * kDegPerRad, contour.corner.empty() ? 0 : static_cast<int>(contour.corner[i]));
        }
    }
    ADD_FAILURE() << n << ": slow at " << zone.phi_from * kDegPerRad << " deg to "
                  << zone.least_speed << " mm/s by " << zone.axis;
  }
}

TEST(SmoothedTables, AddNoSlowZone) {
  std::mt19937_64 random(kSeed);
  Figures figures;
  int asked = 0;
  for (; figures.planned < kNodes && asked < 2 * kNodes; ++asked)
    examine(random_table(random, asked), asked, figures);
  std::cout << figures.planned << " of " << asked << " nodes planned, " << figures.zones
            << " slow zones, " << figures.added << " of them by B\n";
  EXPECT_EQ(figures.planned, kNodes);
}

}  // namespace
}  // namespace tubecut::motion::testing
