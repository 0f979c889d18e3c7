#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>
#include <random>

#include "core/bevel/beam/tongue.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "tests/support/line_distance.hpp"

namespace tubecut::bevel {
namespace {

using testing::from_line, testing::Real, testing::Vec;

/// An end that a laser cuts: B = 0, contact automatic.
TableSpec square_end(double radius, double wall, std::vector<joint::Partner> partners) {
  TableSpec s;
  s.target = {.outer_radius = radius, .wall = wall};
  s.partners = std::move(partners);
  s.sampling.uniform_points = 360;
  s.groove = SquareCut{};
  s.contact = Contact::automatic;
  s.untilted = true;
  s.smoothing = NoSmoothing{};
  return s;
}

joint::TubeCutter tube(double radius, double inclination, double clocking = 0, double offset = 0) {
  return {.radius = radius,
          .inclination = Angle::deg(inclination),
          .clocking = Angle::deg(clocking),
          .offset = offset,
          .height = 0.0};
}

double any(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// A branch r at right angles on a chord R, x across the chord: the inner edge touches at sqrt(R^2 -
// r_i^2 cos^2), the outer one lies straight next to it; a flush bevel follows the chord's tangent.
TEST(UntiltedEnd, SaddleAtRightAnglesLeavesTheClosedFormGap) {
  constexpr double kChord = 60, kOuter = 40, kWall = 4, kInner = kOuter - kWall;
  const auto t = table(square_end(kOuter, kWall, {tube(kChord, 90)}));
  ASSERT_TRUE(t);
  ASSERT_EQ(t->phi.size(), 360u);
  for (std::size_t i = 0; i < t->phi.size(); ++i) {
    const double c = std::pow(std::cos(t->phi[i]), 2);
    const double height = std::sqrt(kChord * kChord - kInner * kInner * c);
    EXPECT_NEAR(t->z_inner[i], height, 1e-9);
    EXPECT_EQ(t->z_outer[i], t->z_inner[i]);
    EXPECT_NEAR(t->gaps.square.inner[i], 0.0, 1e-9);
    const double beside = kOuter * kOuter * c + height * height;
    EXPECT_NEAR(t->gaps.square.outer[i], std::sqrt(beside) - kChord, 1e-9);
    EXPECT_NEAR(t->gaps.bevelled.inner[i], 0.0, 1e-9);
    const double along = kWall * std::sqrt(c) * kChord / height;
    EXPECT_NEAR(t->gaps.bevelled.outer[i], std::sqrt(kChord * kChord + along * along) - kChord,
                1e-9);
  }
  const auto most = greatest(t->gaps.square);
  EXPECT_NEAR(most.gap, std::sqrt(kChord * kChord + kOuter * kOuter - kInner * kInner) - kChord,
              1e-9);
  EXPECT_TRUE(most.outer);
}

Vec axis_point(const joint::TubeCutter& t, Real along, Real around) {
  // Built by motions: round the z axis, shifted, tilted about x, turned about z, lifted.
  const Real r = t.radius, a = t.inclination.rad(), b = t.clocking.rad();
  const Vec p{r * std::cos(around) - t.offset, r * std::sin(around), along};
  const Real y = std::cos(a) * p[1] - std::sin(a) * p[2];
  const Real z = std::sin(a) * p[1] + std::cos(a) * p[2];
  return {std::cos(b) * p[0] - std::sin(b) * y, std::sin(b) * p[0] + std::cos(b) * y, z + t.height};
}

/// The nearest of a tube's surface points by looking at them all, coarse and then ever finer.
Real nearest(const joint::TubeCutter& t, const Vec& p) {
  const Real far = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) + 2 * t.radius +
                   std::abs(t.offset) + std::abs(t.height);
  Real best = std::numeric_limits<Real>::infinity(), at_s = 0, at_w = 0, ds = far, dw = 3.2L;
  for (int round = 0; round < 50; ++round) {
    const int steps = round == 0 ? 40 : 4;
    const Real s0 = at_s, w0 = at_w;
    for (int i = -steps; i <= steps; ++i)
      for (int j = -steps; j <= steps; ++j) {
        const Real s = s0 + ds * i / steps, w = w0 + dw * j / steps;
        const Vec q = axis_point(t, s, w);
        const Real d = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
        if (d < best) best = d, at_s = s, at_w = w;
      }
    ds /= round == 0 ? 16 : 2;
    dw /= round == 0 ? 16 : 2;
  }
  return best;
}

TEST(UntiltedEnd, GapsAreThoseToTheNearestPointsOfThePartners) {
  std::mt19937_64 random(20261123);
  int seen = 0;
  Real worst = 0, widest = 0;
  while (seen < 12) {
    const double radius = any(random, 20, 60);
    const auto chord = tube(radius * any(random, 1.2, 3), any(random, 40, 140), any(random, 0, 360),
                            radius * any(random, -0.15, 0.15));
    auto spec = square_end(radius, radius * any(random, 0.05, 0.25), {chord});
    const auto t = table(spec);
    if (!t) continue;
    ++seen;
    for (std::size_t i = 0; i < t->phi.size(); i += 45) {
      for (const bool outer : {false, true}) {
        const Real r = outer ? spec.target.outer_radius : spec.target.inner_radius();
        const Real z = outer ? t->z_outer[i] : t->z_inner[i];
        const Vec p{r * std::cos(Real{t->phi[i]}), r * std::sin(Real{t->phi[i]}), z};
        const Real stated = (outer ? t->gaps.square.outer : t->gaps.square.inner)[i];
        worst = std::max(worst, std::abs(nearest(chord, p) - std::abs(stated)));
        widest = std::max(widest, stated);
        EXPECT_GE(stated, -1e-9L);
      }
      EXPECT_EQ(t->b[i], 0.0);
    }
  }
  std::cout << seen << " ends: gaps up to " << widest << " mm, off by " << worst << " mm\n";
  EXPECT_LT(worst, 1e-6L);
  EXPECT_GT(widest, 1.0L);
}

double off(const std::vector<double>& a, const std::vector<double>& b, double scale, int shift,
           bool mirrored) {
  const auto n = static_cast<int>(a.size());
  double worst = a.size() == b.size() ? 0.0 : 1e300;
  for (int i = 0; i < n; ++i) {
    const int j = ((mirrored ? -i : i) + shift + 2 * n) % n;
    worst = std::max(
        worst, std::abs(scale * a[static_cast<std::size_t>(i)] - b[static_cast<std::size_t>(j)]));
  }
  return worst;
}
double off(const GapMap& a, const GapMap& b, double scale, int shift, bool mirrored = false) {
  return std::max({off(a.square.inner, b.square.inner, scale, shift, mirrored),
                   off(a.square.outer, b.square.outer, scale, shift, mirrored),
                   off(a.bevelled.inner, b.bevelled.inner, scale, shift, mirrored),
                   off(a.bevelled.outer, b.bevelled.outer, scale, shift, mirrored)});
}

TEST(UntiltedEnd, TurningMirroringAndScalingMoveTheGapsWithThem) {
  const auto one = table(square_end(40, 4, {tube(70, 55, 30, 9), tube(50, 100, 200, -4)}));
  const auto turned = table(square_end(40, 4, {tube(70, 55, 47, 9), tube(50, 100, 217, -4)}));
  // Seen in a mirror through the z axis and x: phi and clocking change their signs, and so does the
  // side on which an axis passes.
  const auto mirrored =
      table(square_end(40, 4, {tube(70, 55, 180 - 30, -9), tube(50, 100, 180 - 200, 4)}));
  const auto doubled = table(square_end(80, 8, {tube(140, 55, 30, 18), tube(100, 100, 200, -8)}));
  ASSERT_TRUE(one && turned && mirrored && doubled);
  EXPECT_LT(off(one->gaps, turned->gaps, 1, 17), 1e-8);
  EXPECT_LT(off(one->gaps, mirrored->gaps, 1, 0, true), 1e-8);
  EXPECT_LT(off(one->gaps, doubled->gaps, 2, 0), 1e-8);
  EXPECT_GT(off(one->gaps, turned->gaps, 1, 16), 1e-3);
}

TEST(UntiltedEnd, EveryContactKeepsTheHeadSquare) {
  for (const auto contact : {Contact::automatic, Contact::none}) {
    auto spec = square_end(40, 4, {tube(60, 60)});
    spec.contact = contact;
    const auto t = table(spec);
    ASSERT_TRUE(t);
    for (const double b : t->b) EXPECT_EQ(b, 0.0);
    const auto least = std::ranges::min(t->gaps.square.outer);
    if (contact == Contact::none)
      EXPECT_LT(least, -0.1);  // the inner wall's profile runs into the chord at the heel
    else
      EXPECT_GT(least, -1e-9);
  }
  auto spec = square_end(40, 4, {tube(60, 60)});
  spec.contact = Contact::inner;
  EXPECT_FALSE(table(spec));
  spec.contact = Contact::automatic;
  spec.torch.min = Angle::deg(5);
  EXPECT_FALSE(table(spec));
}

// A set-in end is flush with a head that tilts; one that does not cuts it square too.
TEST(UntiltedEnd, SetInEndsAreSquareToo) {
  auto spec = square_end(40, 4, {tube(60, 60)});
  spec.stated = {joint::Joint{.kind = joint::JointKind::set_in, .gap = 0.0, .depth = 5.0}};
  const auto t = table(spec);
  ASSERT_TRUE(t);
  for (const double b : t->b) EXPECT_EQ(b, 0.0);
  EXPECT_NEAR(greatest(t->gaps.bevelled).gap, 0.0, 0.5);
}

// An equal saddle ends in two points at the flanks: half a wall behind each the branch has the
// width of its own curve, found by bisection here.
TEST(UntiltedEnd, TongueIsAsWideAsTheCurveOneWallBehindItsTip) {
  constexpr double kChord = 60, kOuter = 40, kWall = 4;
  const auto t = table(square_end(kOuter, kWall, {tube(kChord, 90)}));
  ASSERT_TRUE(t);
  const auto tongue = narrowest_tongue({.outer_radius = kOuter, .wall = kWall}, *t, false);
  ASSERT_TRUE(tongue);
  // Both walls have one height at B = 0; the bore is the shorter way round. Tips at phi 0, 180.
  const double inner = kOuter - kWall;
  const auto height = [&](double phi) {
    return std::sqrt(kChord * kChord - std::pow(inner * std::cos(phi), 2));
  };
  double low = 0, high = kPi / 2;
  for (int k = 0; k < 80; ++k) {
    const double mid = (low + high) / 2;
    (height(mid) < height(0) + kWall ? low : high) = mid;
  }
  EXPECT_NEAR(tongue->width, 2 * inner * low, 1e-3 * inner);
  EXPECT_NEAR(std::abs(std::cos(tongue->phi)), 1.0, 1e-12);
  EXPECT_EQ(tongue->radius, inner);
}

TEST(UntiltedEnd, ASquareCutHasNoTongue) {
  const auto t = table(square_end(40, 4, {joint::PlaneCutter{.point = {0, 0, 10}}}));
  ASSERT_TRUE(t);
  EXPECT_FALSE(narrowest_tongue({.outer_radius = 40, .wall = 4}, *t, false));
  EXPECT_NEAR(reach(*t), 0.0, 1e-12);
}

HoleSpec square_hole(std::mt19937_64& random) {
  HoleSpec s;
  s.chord.outer_radius = any(random, 30, 300);
  s.chord.wall = s.chord.outer_radius * any(random, 0.03, 0.2);
  const double radius = s.chord.outer_radius * any(random, 0.15, 0.7);
  s.branch_wall = radius * any(random, 0.05, 0.3);
  s.kind = any(random, 0, 1) < 0.5 ? JointKind::set_in : JointKind::through;
  s.gap = any(random, 0, 2);
  s.branch = tube(radius, any(random, 35, 145), any(random, 0, 360),
                  any(random, -0.25, 0.25) * s.chord.outer_radius);
  s.groove = SquareCut{};
  s.tilt = Tilt::none;
  s.sampling.tolerance = joint::Tolerance{.value = 0.005};
  return s;
}

// Whatever the lean, the wall is square to the chord and touches the branch with its gap around it
// somewhere across: no wider than needed, and nowhere nearer.
TEST(UntiltedHole, TouchesTheBranchSomewhereAcrossTheWallAndNowhereEnters) {
  std::mt19937_64 random(20261124);
  int seen = 0, refused = 0;
  Real near_rows = 0, wide = 0, near_between = 0, widened = 0;
  while (seen < 100) {
    const auto spec = square_hole(random);
    const auto cut = hole(spec);
    if (!cut) {
      ++refused;
      continue;
    }
    ++seen;
    const auto branch = std::get<joint::TubeCutter>(spec.branch);
    auto thin = branch;
    thin.radius = 0;
    const Vec q = axis_point(thin, 0, 0), e = axis_point(thin, 1, 0);
    const Vec d{e[0] - q[0], e[1] - q[1], e[2] - q[2]};
    for (const auto& h : cut->holes)
      for (std::size_t i = 0; i < h.phi.size(); ++i) {
        EXPECT_EQ(h.b[i], 0.0);
        EXPECT_EQ(h.a[i], 0.0);
        const auto j = (i + 1) % h.phi.size();
        for (const Real u : {0.0L, 0.5L}) {
          const auto mean = [&](const std::vector<double>& v) { return (1 - u) * v[i] + u * v[j]; };
          Real least = 1e300L, root = 0;
          for (int k = 0; k <= 100; ++k) {
            const Real v = k / 100.0L;
            const Real ri = spec.chord.inner_radius(), ro = spec.chord.outer_radius;
            const Vec a{ri * std::cos(mean(h.phi_inner)), ri * std::sin(mean(h.phi_inner)),
                        mean(h.z_inner)};
            const Vec b{ro * std::cos(mean(h.phi)), ro * std::sin(mean(h.phi)), mean(h.z)};
            Vec p;
            for (std::size_t c = 0; c < 3; ++c) p[c] = (1 - v) * a[c] + v * b[c];
            const Real gap = from_line(p, q, d) - branch.radius - spec.gap;
            least = std::min(least, gap);
            if (k == 0) root = gap;
          }
          if (u == 0) {
            near_rows = std::max(near_rows, -least);
            wide = std::max(wide, least);
            widened = std::max(widened, root);
          } else {
            near_between = std::max(near_between, -least);
          }
        }
      }
    for (const auto& check : verify(spec, *cut)) EXPECT_LE(check.value, check.limit) << check.name;
  }
  std::cout << seen << " holes (" << refused << " refused): enters by " << near_rows
            << ", stands off by " << wide << ", between rows by " << near_between
            << "; the root stands up to " << widened << " mm off\n";
  EXPECT_LT(near_rows, 1e-9L);
  EXPECT_LT(wide, 1e-3L);  // of the 100 places looked at
  EXPECT_LT(near_between, 0.0055L);
  EXPECT_GT(widened, 1.0L);  // leaning branches do need more than their root's curve
  EXPECT_LT(refused, 100);
}

TEST(UntiltedHole, KerfKeepsTheBeamOffAndASetOnHoleIsSquareToo) {
  std::mt19937_64 random(7);
  int seen = 0;
  while (seen < 60) {
    auto spec = square_hole(random);
    if (seen % 3 == 0) spec.kind = JointKind::set_on;
    spec.kerf = any(random, 0.1, 2);
    const auto cut = hole(spec);
    if (!cut) continue;
    ++seen;
    for (const auto& h : cut->holes)
      for (const double b : h.b) EXPECT_EQ(b, 0.0);
    for (const auto& check : verify(spec, *cut)) EXPECT_LE(check.value, check.limit) << check.name;
    for (const auto& warning : cut->warnings)
      EXPECT_NE(warning.code, WarningCode::torch_range_binds);
  }
}

}  // namespace
}  // namespace tubecut::bevel
