#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string_view>

#include "core/bevel/hole.hpp"
#include "tests/support/cut_oracle.hpp"
#include "tests/support/random_cut.hpp"

// Between two rows of a hole or of the branch's end that goes with it: how much nearer than the
// asked gap does the wall come to the other member?

namespace tubecut::bevel {
namespace {

HoleSpec random_hole(oracle::Random& random) {
  HoleSpec s;
  s.chord.outer_radius = random.any(30, 300);
  s.chord.wall = s.chord.outer_radius * random.any(0.03, 0.2);
  const double radius = s.chord.outer_radius * random.any(0.15, 0.85);
  s.branch_wall = radius * random.any(0.05, 0.3);
  s.kind = std::array{JointKind::set_on, JointKind::set_in, JointKind::through}[random.upto(2)];
  s.gap = random.chance(0.3) ? 0.0 : random.any(0, 3);
  s.branch = joint::TubeCutter{
      .radius = radius,
      .inclination = Angle::deg(random.chance(0.2) ? 90 : random.any(35, 145)),
      .clocking = Angle::deg(random.any(0, 360)),
      .offset = random.chance(0.3) ? 0.0 : random.any(-0.3, 0.3) * s.chord.outer_radius,
      .height = random.any(-200, 200)};
  s.groove = oracle::random_groove(random);
  if (std::holds_alternative<ZonedGroove>(s.groove)) s.groove = NoGroove{};
  s.tilt = random.chance(0.5) ? Tilt::axial : Tilt::free;
  s.kerf = random.chance(0.5) ? 0.0 : random.any(0, 4);
  s.sampling.tolerance = joint::Tolerance{
      .value = random.chance(0.5) ? 0.05 : random.any(0.005, 0.3),
      .metric = random.chance(0.3) ? joint::Metric::chord : joint::Metric::developed};
  return s;
}

/// What faces the other member, and that member with the asked gap around it.
struct Facing {
  oracle::Wall wall;
  oracle::Solid other;
};

Facing facing(const HoleSpec& spec, const HoleCut& cut, const Hole& hole) {
  const auto branch = std::get<joint::TubeCutter>(spec.branch);
  if (spec.kind != JointKind::set_on)
    return {{.edges = {{spec.chord.inner_radius(), hole.phi_inner, hole.z_inner},
                       {spec.chord.outer_radius, hole.phi, hole.z}},
             .turn = 0.0},
            oracle::solid_of(branch, spec.gap)};
  auto chord = cut.branch->chord;
  chord.radius = spec.chord.outer_radius;
  return {{.edges = {{branch.radius - spec.branch_wall, cut.branch->phi, cut.branch->z_inner},
                     {branch.radius, cut.branch->phi, cut.branch->z_outer}},
           .turn = kTwoPi},
          oracle::solid_of(chord, spec.gap)};
}

int count_of(const char* name, int otherwise) {
  const char* asked = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return asked != nullptr ? std::atoi(asked) : otherwise;
}

bool passes(const std::vector<Check>& checks) {
  return std::ranges::all_of(checks, &Check::passed);
}

/// The row after the nearest place's brought nearer by twice the tolerance.
HoleCut nearer(const HoleSpec& spec, HoleCut cut, std::size_t gap) {
  const auto branch = std::get<joint::TubeCutter>(spec.branch);
  auto& hole = cut.holes.front();
  const auto row = (gap + 1) % hole.phi.size();
  const double by = 2.0 * spec.sampling.tolerance->value;
  if (cut.branch && spec.kind == JointKind::set_on) {
    for (auto* z : {&cut.branch->z_inner, &cut.branch->z_outer}) (*z)[row] -= by;
    return cut;
  }
  const double to_middle = hole.z[row] > branch.height ? -by : by;
  for (auto* z : {&hole.z, &hole.z_inner}) (*z)[row] += to_middle;
  return cut;
}

// The full count: TUBECUT_HOLES=600.
TEST(HoleBetweenRows, NoRandomHoleComesNearerThanItsToleranceAllows) {
  constexpr std::uint64_t kSeed = 20261123;
  const int holes = count_of("TUBECUT_HOLES", 40);
  std::cout << "seed " << kSeed << '\n';
  oracle::Random random{std::mt19937_64(kSeed)};
  std::map<std::string_view, int> refused;
  int answered = 0;
  double worst_share = 0.0, worst_stated = 0.0;
  for (int n = 0; n < holes; ++n) {
    const auto spec = random_hole(random);
    const auto cut = hole(spec);
    if (!cut) {
      ++refused[info(cut.error().code()).code];
      continue;
    }
    ++answered;
    for (const auto& check : verify(spec, *cut))
      EXPECT_TRUE(check.passed()) << n << ' ' << check.name << ' ' << check.value;
    for (const auto& one : cut->holes) {
      const auto [wall, other] = facing(spec, *cut, one);
      const auto found = oracle::deepest(wall, {&other, 1});
      worst_share = std::max(worst_share, found.depth / spec.sampling.tolerance->value);
      const double off = std::abs(spec.gap - std::max(0.0, found.depth) - one.fit.least_between);
      worst_stated = std::max(worst_stated, off);
      EXPECT_LE(found.depth, spec.sampling.tolerance->value) << n;
      EXPECT_LE(off, 1e-3) << n;
      if (!one.far) {
        EXPECT_FALSE(passes(verify(spec, nearer(spec, *cut, found.gap)))) << n;
      }
    }
  }
  std::cout << answered << " answered; nearest " << worst_share
            << " of the tolerance, stated within " << worst_stated << " mm\n";
  for (const auto& [code, count] : refused) std::cout << code << ' ' << count << '\n';
  EXPECT_GE(answered, holes * 3 / 4);
}

// Twelve points round a hole cut the corners: said, with where and how much.
TEST(HoleBetweenRows, ABareGridSaysWhatItsPointsMiss) {
  for (const auto kind : {JointKind::set_on, JointKind::set_in, JointKind::through})
    for (const std::size_t points : {12U, 720U}) {
      HoleSpec spec;
      spec.chord = {.outer_radius = 84.15, .wall = 8.0};
      spec.branch = joint::TubeCutter{.radius = 44.45,
                                      .inclination = Angle::deg(60),
                                      .clocking = Angle::deg(90),
                                      .offset = 10.0,
                                      .height = 30.0};
      spec.branch_wall = 5.0;
      spec.kind = kind;
      spec.gap = 2.0;
      spec.groove = FixedGroove{Angle::deg(30)};
      spec.sampling.uniform_points = points;
      const auto cut = hole(spec);
      ASSERT_TRUE(cut);
      EXPECT_TRUE(passes(verify(spec, *cut)));
      double deepest = 0.0;
      for (const auto& one : cut->holes) {
        const auto [wall, other] = facing(spec, *cut, one);
        const double depth = oracle::deepest(wall, {&other, 1}).depth;
        EXPECT_NEAR(one.fit.nearest.depth, std::max(0.0, depth), 1e-3);
        deepest = std::max(deepest, depth);
      }
      const auto warned =
          std::ranges::count(cut->warnings, WarningCode::enters_partner, &Warning::code);
      EXPECT_EQ(warned > 0, deepest > 0.05) << points;
      EXPECT_EQ(warned > 0, points == 12U) << deepest;
    }
}

}  // namespace
}  // namespace tubecut::bevel
