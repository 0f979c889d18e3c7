// Legs of pipe supports: tubes that are set on a bend along one of its own straight runs. The
// oracle is the closed form of a line through a torus and a cylinder, in the bend's plane, in long
// double.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <random>

#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;
using Real = long double;

constexpr Real kPiL = 3.141592653589793238462643383279502884L;

/// A bend whose one run lies on the z axis; it bends towards +x from z = 0. `rises`: the run comes
/// from above and the bend lies below.
struct Bend {
  Real radius, bend_radius, bend;  // rad
  bool rises = false;

  /// The highest point of the vertical line at (x, y); empty if it misses.
  [[nodiscard]] std::optional<Real> top(Real x, Real y) const {
    std::optional<Real> best;
    const auto see = [&](Real z) {
      const Real up = rises ? -z : z;
      if (!best || up > *best) best = up;
    };
    const Real s = std::sqrt(std::max(Real{0}, radius * radius - y * y));
    if (std::abs(y) <= radius)
      for (const Real reach : {bend_radius + s, bend_radius - s}) {
        const Real square = reach * reach - (bend_radius - x) * (bend_radius - x);
        if (square < 0) continue;
        for (const Real z : {std::sqrt(square), -std::sqrt(square)}) {
          const Real turn = std::atan2(z, bend_radius - x);
          if (turn >= 0 && turn <= bend) see(z);
        }
      }
    // The other run: from the bend's end along (sin, 0, cos) of the angle turned.
    const Real sine = std::sin(bend), cosine = std::cos(bend);
    const Real px = bend_radius * (1 - cosine), pz = bend_radius * sine;
    if (std::abs(y) <= radius && std::abs(sine) > 1e-9L)
      for (const Real side : {s, -s}) {
        // At `side` from its axis, in the plane: (x - px) cos - (z - pz) sin = side.
        const Real z = pz + ((x - px) * cosine - side) / sine;
        if ((x - px) * sine + (z - pz) * cosine >= 0) see(z);
      }
    return best;
  }
};

struct Case {
  Bend bend{};
  Real x = 0, y = 0;  // of the tube's axis, from the run's
  Target target{};
  ElbowCutter elbow{};
  double turn = 0.0;  // about the run
};

/// The bend in the frame of the tube, drawn from either of its ends, turned about the run and
/// leaning by `lean` (rad) about the work point.
void place(Case& c, bool from_far_end, double lean, double about) {
  const auto& b = c.bend;
  const double up = b.rises ? -1.0 : 1.0;
  const double sine = std::sin(static_cast<double>(b.bend));
  const double cosine = std::cos(static_cast<double>(b.bend));
  const auto big = static_cast<double>(b.bend_radius);
  Vector3d point = Vector3d::Zero(), along(0, 0, up), inwards(1, 0, 0);
  if (from_far_end) {
    point = {big * (1 - cosine), 0, up * big * sine};
    along = {-sine, 0, -up * cosine};
    inwards = {cosine, 0, -up * sine};
  }
  const Vector3d axis(std::cos(about), std::sin(about), 0.0);
  const Eigen::Matrix3d turned =
      (Eigen::AngleAxisd(lean, axis) * Eigen::AngleAxisd(c.turn, Vector3d::UnitZ())).matrix();
  const Vector3d off(static_cast<double>(c.x), static_cast<double>(c.y), 0.0);
  c.elbow = {.radius = static_cast<double>(b.radius),
             .bend_radius = big,
             .bend = Angle::rad(static_cast<double>(b.bend)),
             .point = turned * (point - off),
             .direction = turned * along,
             .inwards = turned * inwards};
}

class Random {
 public:
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool coin() { return any(0, 1) < 0.5; }
  /// On the back of the bend (its run goes away), or inside it, next to the rising run.
  Case leg(bool inside) {
    Case c;
    c.bend.radius = any(20, 200);
    c.bend.bend_radius = c.bend.radius * any(1.3, 4.0);
    c.bend.bend = coin() ? kPiL / 2 : kPiL * any(25, 150) / 180;
    c.bend.rises = inside;
    const double big = static_cast<double>(c.bend.radius);
    const double rho = big * any(0.25, 0.85);
    c.target = {.outer_radius = rho, .wall = std::max(1.5, rho * any(0.05, 0.2))};
    c.turn = any(0, kTwoPi);
    if (inside) {
      c.bend.bend = kPiL * any(70, 100) / 180;
      c.x = big + rho + any(1, 60);
      c.y = any(-0.9, 0.9) * (big - rho);
    } else if (coin()) {
      const double room = 0.98 * (big - rho), at = any(0, kTwoPi);
      c.x = room * std::cos(at);
      c.y = room * std::sin(at);
    }
    return c;
  }

 private:
  std::mt19937_64 engine_{20260907};
};

IntersectionSpec spec_of(const Case& c) {
  return {.target = c.target,
          .partners = {c.elbow},
          .surfaces = Surfaces::both,
          .sampling = {.uniform_points = 48}};
}

/// The worst difference of z between both curves and the closed form; `slack`: the sideways tilt of
/// the bend.
Real worst_of(const Case& c, const Intersection& curves) {
  Real worst = 0;
  for (const auto& curve : curves.profiles)
    for (std::size_t i = 0; i < curve.phi.size(); ++i) {
      const Real phi = curve.phi[i] - c.turn;
      const auto z =
          c.bend.top(c.x + curve.radius * std::cos(phi), c.y + curve.radius * std::sin(phi));
      if (!z) return INFINITY;
      worst = std::max(worst, std::abs(*z - curve.z[i]));
    }
  return worst;
}

void expect_proved(const std::vector<Check>& checks, int n) {
  for (const auto& check : checks)
    EXPECT_TRUE(check.passed()) << n << ' ' << check.name << ' ' << check.value;
}

TEST(ElbowLeg, FollowsTheClosedForm) {
  Random random;
  int answered = 0;
  Real worst = 0;
  for (int n = 0; n < 240; ++n) {
    auto c = random.leg(n % 3 == 2);
    place(c, random.coin(), 0.0, 0.0);
    const auto curves = intersect(spec_of(c));
    if (!curves) {
      // Next to a rising run the tube may reach beyond the bend, or the bend may hide a part of
      // itself.
      const auto code = curves.error().code();
      EXPECT_TRUE(c.bend.rises &&
                  (code == ErrorCode::open_profile || code == ErrorCode::no_contact ||
                   code == ErrorCode::unsupported_combination))
          << n << ' ' << info(code).code;
      continue;
    }
    ++answered;
    worst = std::max(worst, worst_of(c, *curves) / (c.bend.radius + c.bend.bend_radius));
    expect_proved(verify(spec_of(c), *curves), n);
  }
  std::cout << answered << " of 240 legs, off by " << worst << " of the bend's size\n";
  EXPECT_GE(answered, 220);
  EXPECT_LT(worst, 1e-11L);
}

// A leg drawn with rounded coordinates leans by a little: its height changes by no more than that
// lean moves a place of the bend, as steep as the bend is there.
TEST(ElbowLeg, LeansByTheRoundingOfADrawing) {
  Random random;
  for (int n = 0; n < 200; ++n) {
    auto c = random.leg(false);
    c.x *= 0.8L;
    c.y *= 0.8L;
    const double lean = std::pow(10.0, random.any(-12, -2.3));
    place(c, random.coin(), lean, random.any(0, kTwoPi));
    const auto curves = intersect(spec_of(c));
    ASSERT_TRUE(curves) << n << ' ' << info(curves.error().code()).code << " at " << lean;
    expect_proved(verify(spec_of(c), *curves), n);
    const double size = c.elbow.radius + c.elbow.bend_radius;
    const double aside = size * lean;  // maximum displacement of the bend near the tube
    for (const auto& curve : curves->profiles)
      for (std::size_t i = 0; i < curve.phi.size(); ++i) {
        const Real phi = curve.phi[i] - c.turn;
        Real least = INFINITY, most = -INFINITY;
        for (int k = 0; k < 17; ++k) {
          const Real to = 2 * kPiL * k / 16, by = k == 16 ? 0 : 1.5L * aside;
          const auto z = c.bend.top(c.x + curve.radius * std::cos(phi) + by * std::cos(to),
                                    c.y + curve.radius * std::sin(phi) + by * std::sin(to));
          if (!z) continue;
          least = std::min(least, *z);
          most = std::max(most, *z);
        }
        const Real slack = 2 * aside + 1e-9L * size;
        EXPECT_LE(curve.z[i], most + slack) << n;
        EXPECT_GE(curve.z[i], least - slack) << n;
      }
  }
}

TEST(ElbowLeg, OfABevelTableIsProved) {
  Random random;
  int answered = 0;
  for (int n = 0; n < 40; ++n) {
    auto c = random.leg(n % 4 == 3);
    place(c, random.coin(), n % 2 == 0 ? 0.0 : 3e-6, random.any(0, kTwoPi));
    bevel::TableSpec spec;
    spec.target = c.target;
    spec.partners = {c.elbow};
    spec.sampling.uniform_points = 60;
    spec.groove = bevel::HalfDihedral{};
    spec.smoothing = bevel::NoSmoothing{};
    const auto made = bevel::table(spec);
    if (!made) {
      EXPECT_EQ(made.error().code(), ErrorCode::torch_range) << n;
      continue;
    }
    ++answered;
    expect_proved(bevel::verify(spec, *made), n);
  }
  std::cout << answered << " of 40 tables\n";
  EXPECT_GE(answered, 30);
}

// If the run goes up inside the kept tube's wall, there is no end to cut, and the refusal reports
// it.
TEST(ElbowLeg, IsRefusedIfTheRunRisesWithin) {
  Random random;
  for (int n = 0; n < 200; ++n) {
    auto c = random.leg(false);
    c.bend.rises = true;
    const double lean = n % 2 == 0 ? 0.0 : std::pow(10.0, random.any(-12, -5));
    place(c, random.coin(), lean, random.any(0, kTwoPi));
    const auto curves = intersect(spec_of(c));
    ASSERT_FALSE(curves) << n;
    const auto& issue = curves.error().issues.front();
    EXPECT_EQ(issue.code, ErrorCode::parallel_axes) << n;
    EXPECT_EQ(issue.member, "cutters/0");
    EXPECT_FALSE(issue.hint.empty());
  }
}

}  // namespace
}  // namespace tubecut::joint
