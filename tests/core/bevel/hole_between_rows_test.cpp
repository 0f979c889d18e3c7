#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string_view>

#include "core/bevel/beam/beam.hpp"
#include "core/bevel/hole/hole.hpp"
#include "tests/support/cut_oracle.hpp"
#include "tests/support/random_cut.hpp"

// Between two rows of a hole or of its branch's end: the amount by which the wall comes nearer to
// the other member than the requested gap.

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
  s.tilt = std::array{Tilt::axial, Tilt::free, Tilt::none}[random.upto(2)];
  s.kerf = random.chance(0.5) ? 0.0 : random.any(0, 4);
  s.sampling.tolerance = joint::Tolerance{
      .value = random.chance(0.5) ? 0.05 : random.any(0.005, 0.3),
      .metric = random.chance(0.3) ? joint::Metric::chord : joint::Metric::developed};
  return s;
}

/// The edges that face the other member, and that member with the requested gap around it.
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

// The edges of a wall that does not tilt lie within the tolerance of their curves wherever they are
// looked at, and the wall between them nearer to the branch than that.
TEST(HoleBetweenRows, AnEyeOfARailComesNoNearerThanItsToleranceAllows) {
  oracle::Random random{std::mt19937_64(20261124)};
  double worst_share = 0.0;
  for (int n = 0; n < 60; ++n) {
    HoleSpec s;
    s.chord = {.outer_radius = 30.15, .wall = 4.0};
    s.branch_wall = 2.87;
    s.kind = JointKind::through;
    s.gap = 0.3;
    s.branch = joint::TubeCutter{.radius = 13.35,
                                 .inclination = Angle::deg(90.0 + random.any(0, 1)),
                                 .clocking = Angle::deg(180)};
    s.tilt = Tilt::none;
    s.kerf = 0.2;
    s.sampling.tolerance = joint::Tolerance{.value = random.any(0.045, 0.055)};
    const auto cut = hole(s);
    ASSERT_TRUE(cut) << n;
    for (const auto& check : verify(s, *cut))
      EXPECT_TRUE(check.passed()) << n << ' ' << check.name << ' ' << check.value;
    for (const auto& one : cut->holes) {
      const auto [wall, other] = facing(s, *cut, one);
      worst_share = std::max(
          worst_share, oracle::deepest(wall, {&other, 1}).depth / s.sampling.tolerance->value);
    }
  }
  EXPECT_LE(worst_share, 1.0);
  EXPECT_GT(worst_share, 0.5);  // or no case comes near its limit
}

using Point = std::array<double, 3>;

Point on_wall(double radius, double phi, double z) {
  return {radius * std::cos(phi), radius * std::sin(phi), z};
}

/// Of the straight way in phase and height from each row to the next, `parts` places.
std::vector<std::array<double, 4>> along(const std::array<const std::vector<double>*, 4>& columns,
                                         int parts) {
  std::vector<std::array<double, 4>> out;
  const auto n = columns[0]->size();
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < parts; ++k) {
      std::array<double, 4> at{};
      for (std::size_t c = 0; c < 4; ++c)
        at[c] = std::lerp((*columns[c])[i], (*columns[c])[(i + 1) % n], 1.0 * k / parts);
      out.push_back(at);
    }
  return out;
}

/// Metal that a round beam of the kerf's width takes from the finished wall, mm: points of the wall
/// against straight axes, all pairs.
double taken(const HoleSpec& spec, const Hole& hole) {
  const double inner = spec.chord.inner_radius(), outer = spec.chord.outer_radius;
  const int parts = std::max(1, 1500 / static_cast<int>(hole.phi.size()));
  std::vector<Point> wall;
  for (const auto& [pi, zi, po, zo] :
       along({&hole.phi_inner, &hole.z_inner, &hole.phi, &hole.z}, parts))
    for (int m = 0; m <= 8; ++m) {
      const auto a = on_wall(inner, pi, zi), b = on_wall(outer, po, zo);
      wall.push_back({std::lerp(a[0], b[0], m / 8.0), std::lerp(a[1], b[1], m / 8.0),
                      std::lerp(a[2], b[2], m / 8.0)});
    }
  double nearest = 1e300;
  for (const auto& [pi, zi, po, zo] :
       along({&hole.torch_phi_inner, &hole.torch_z_inner, &hole.torch_phi, &hole.torch_z}, parts)) {
    const auto foot = on_wall(inner, pi, zi), top = on_wall(outer, po, zo);
    const Point way{top[0] - foot[0], top[1] - foot[1], top[2] - foot[2]};
    const double square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
    for (const auto& q : wall) {
      const Point off{q[0] - foot[0], q[1] - foot[1], q[2] - foot[2]};
      const double s = (off[0] * way[0] + off[1] * way[1] + off[2] * way[2]) / square;
      nearest =
          std::min(nearest, off[0] * off[0] + off[1] * off[1] + off[2] * off[2] - s * s * square);
    }
  }
  return 0.5 * spec.kerf - std::sqrt(std::max(0.0, nearest));
}

// Half a kerf off the wall's own line took up to 0.85 mm from the adjacent wall. TUBECUT_HOLES=600:
// all.
TEST(HoleTorchLine, StaysOutOfTheChord) {
  oracle::Random random{std::mt19937_64(77)};
  std::vector<double> lefts;
  double worst = 0.0, apart = 0.0;
  int withheld = 0;
  for (int n = 0; n < count_of("TUBECUT_HOLES", 25); ++n) {
    auto spec = random_hole(random);
    if (spec.kerf == 0.0) spec.kerf = random.any(0.5, 4);
    const auto cut = hole(spec);
    if (!cut) continue;
    for (const auto& check : verify(spec, *cut)) {
      withheld += check.passed() ? 0 : 1;
      EXPECT_TRUE(check.passed()) << n << ' ' << check.name << ' ' << check.value;
    }
    for (const auto& one : cut->holes) {
      const double found = taken(spec, one);
      worst = std::max(worst, found);
      apart = std::max(apart, found - one.torch_line.gouge);
      EXPECT_LE(found, kGougeLimit) << n;
      EXPECT_LE(found, one.torch_line.gouge + 1e-3) << n;
      lefts.push_back(one.torch_line.left);
    }
  }
  std::ranges::sort(lefts);
  std::cout << lefts.size() << " holes: at most " << worst << " mm taken, " << apart
            << " more than stated; left median " << lefts[lefts.size() / 2] << ", 90 % "
            << lefts[lefts.size() * 9 / 10] << ", most " << lefts.back() << '\n';
}

// An axis moved towards the chord, or the wall towards the axis.
TEST(HoleTorchLine, ACorruptedRowIsSeen) {
  oracle::Random random{std::mt19937_64(77)};
  int tried = 0;
  for (int n = 0; n < 12; ++n) {
    auto spec = random_hole(random);
    spec.kerf = 2.0;
    const auto cut = hole(spec);
    if (!cut) continue;
    ++tried;
    auto bad = *cut;
    auto& h = bad.holes.front();
    const auto row = h.phi.size() / 3;
    h.torch_phi[row] += 0.1 * (h.phi[row] - h.torch_phi[row]);
    h.torch_z[row] += 0.1 * (h.z[row] - h.torch_z[row]);
    const auto checks = verify(spec, bad);
    EXPECT_TRUE(std::ranges::any_of(checks, [](const Check& check) {
      return check.name == "gouge" && !check.passed();
    })) << n;
  }
  EXPECT_GE(tried, 8);
}

// Twelve points round a hole cut the corners: reported, with position and amount.
TEST(HoleBetweenRows, ABareGridReportsTheErrorBetweenItsPoints) {
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
