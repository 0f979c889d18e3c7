#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include "core/base/try.hpp"
#include "core/joint/contour.hpp"
#include "core/joint/solid.hpp"

// Boxes and cones as partners, against a ray caster in long double that knows only how far a point
// lies outside: it searches for the deepest point of the generator and brackets its way out.

namespace tubecut::joint {
namespace {

using Real = long double;
using Vec = std::array<Real, 3>;

constexpr std::uint64_t kSeed = 20260121;
constexpr int kPlacements = 200;
constexpr int kPhases = 60;
constexpr int kScan = 2000;
constexpr double kTolerance = 1e-7;  // mm

using Outside = std::function<Real(const Vec&)>;

Vec from(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec minus(const Vec& a, const Vec& b, Real k = 1) {
  return {a[0] - k * b[0], a[1] - k * b[1], a[2] - k * b[2]};
}
Vec unit(const Vec& a) {
  const Real n = std::sqrt(dot(a, a));
  return {a[0] / n, a[1] / n, a[2] / n};
}
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Outside outside(const RectangularTubeCutter& box) {
  const Vec d = unit(from(box.direction));
  const Vec up = unit(minus(from(box.up), d, dot(from(box.up), d)));
  const Vec across = cross(up, d);
  const Vec q = from(box.point);
  const Real a = box.width / 2.0L - box.corner, b = box.height / 2.0L - box.corner;
  return [=](const Vec& p) -> Real {
    const Real x = std::abs(dot(minus(p, q), across)) - a;
    const Real y = std::abs(dot(minus(p, q), up)) - b;
    const Real ox = std::max<Real>(x, 0), oy = std::max<Real>(y, 0);
    return std::sqrt(ox * ox + oy * oy) + std::min<Real>(std::max(x, y), 0) - box.corner;
  };
}

Outside outside(const ConeCutter& cone) {
  const Vec d = unit(from(cone.direction));
  const Vec q = from(cone.point);
  const Real slope = std::tan(static_cast<Real>(cone.half_angle.rad()));
  return [=](const Vec& p) -> Real {
    const Vec v = minus(p, q);
    const Real along = dot(v, d);
    const Vec beside = minus(v, d, along);
    return std::sqrt(dot(beside, beside)) - (cone.radius + slope * along);
  };
}

Outside outside(const TubeCutter& t) {
  const Real a = t.inclination.rad(), b = t.clocking.rad();
  const Vec d{std::sin(a) * std::sin(b), -std::sin(a) * std::cos(b), std::cos(a)};
  const Vec q{-t.offset * std::cos(b), -t.offset * std::sin(b), t.height};
  return [=](const Vec& p) -> Real {
    const Vec c = cross(minus(p, q), d);
    return std::sqrt(dot(c, c)) - t.radius;
  };
}

Outside outside(const PlaneCutter& plane) {
  Vec n = unit(from(plane.normal));
  if (n[2] < 0) n = {-n[0], -n[1], -n[2]};
  const Vec q = from(plane.point);
  return [=](const Vec& p) { return dot(minus(p, q), n); };
}

/// Arc and legs each in its own place, by the angle around the bend's axis.
Outside outside(const ElbowCutter& elbow) {
  const Vec y = unit(from(elbow.direction));
  const Vec in = unit(minus(from(elbow.inwards), y, dot(from(elbow.inwards), y)));
  const Vec n = cross(y, in);
  const Real bend = elbow.bend.rad(), big = elbow.bend_radius, small = elbow.radius;
  const Vec center = minus(from(elbow.point), in, -big);
  return [=](const Vec& p) -> Real {
    const Vec v = minus(p, center);
    const Real px = -dot(v, in), py = dot(v, y), pz = dot(v, n);
    Real best = 1e9L;
    const Real angle = std::atan2(py, px);
    if (angle >= 0 && angle <= bend) {
      const Real r = std::sqrt(px * px + py * py) - big;
      best = std::min(best, std::sqrt(r * r + pz * pz) - small);
    }
    const Real ex = std::cos(bend) * px + std::sin(bend) * py;
    const Real ey = std::cos(bend) * py - std::sin(bend) * px;
    if (py <= 0) best = std::min(best, std::sqrt((px - big) * (px - big) + pz * pz) - small);
    if (ey >= 0) best = std::min(best, std::sqrt((ex - big) * (ex - big) + pz * pz) - small);
    return best;
  };
}

/// `deepest` is how far the generator enters at all; > 0: by how much it misses.
struct Top {
  Real z = 0, deepest = 0;
};

/// The highest point of any body, by half of the free way at a time, then by bisection.
Top marched(const Outside& f, Real rho, Real phi) {
  Vec p{rho * std::cos(phi), rho * std::sin(phi), 0};
  Top out{0, 1e9L};
  Real above = 3000;
  for (Real z = above; z > -3000;) {
    p[2] = z;
    const Real away = f(p);
    if (away < out.deepest) out = {z, away};
    if (away <= 0) break;
    above = z;
    z -= std::max<Real>(away / 2, 1e-7L);
  }
  if (out.deepest > 0) return out;
  Real in = out.z;
  for (int i = 0; i < 70; ++i) {
    const Real mid = (in + above) / 2;
    p[2] = mid;
    (f(p) <= 0 ? in : above) = mid;
  }
  return {in, out.deepest};
}

/// The bodies are convex along the generator. `deepest` is how far the generator enters at all.
Top top(const Outside& f, Real rho, Real phi) {
  Vec p{rho * std::cos(phi), rho * std::sin(phi), 0};
  const auto at = [&](Real z) {
    p[2] = z;
    return f(p);
  };
  Real low = -1e5L, high = 1e5L;
  for (int i = 0; i < 150; ++i) {
    const Real left = low + (high - low) / 3, right = high - (high - low) / 3;
    (at(left) < at(right) ? high : low) = at(left) < at(right) ? right : left;
  }
  Real in = (low + high) / 2;
  const Real deepest = at(in);
  Real out = 1e5L;
  for (int i = 0; i < 90; ++i) {
    const Real mid = (in + out) / 2;
    (at(mid) <= 0 ? in : out) = mid;
  }
  return {in, deepest};
}

double any(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Eigen::Vector3d direction(std::mt19937_64& random, double steepest) {
  const double phi = any(random, 0, kTwoPi), rise = any(random, -steepest, steepest);
  return {std::cos(phi), std::sin(phi), rise};
}

RectangularTubeCutter random_box(std::mt19937_64& random, double rho, bool closed) {
  RectangularTubeCutter box;
  box.width = rho * (closed ? any(random, 2.6, 4.0) : any(random, 0.5, 2.5));
  box.height = rho * (closed ? any(random, 2.6, 4.0) : any(random, 0.5, 2.5));
  box.corner = std::min(box.width, box.height) * any(random, 0.01, 0.5);
  const double shift = closed ? 0.1 : 0.8;
  box.point = {any(random, -shift, shift) * rho, any(random, -shift, shift) * rho,
               any(random, -50, 50)};
  box.direction = direction(random, 1.5);
  box.up = {any(random, -1, 1), any(random, -1, 1), 2.0};
  return box;
}

ConeCutter random_cone(std::mt19937_64& random, double rho, bool closed) {
  ConeCutter cone;
  cone.radius = rho * (closed ? any(random, 1.6, 3.0) : any(random, 0.3, 1.5));
  cone.half_angle = Angle::deg(closed ? any(random, -15, 15) : any(random, -40, 40));
  const double shift = closed ? 0.2 : 1.0;
  cone.point = {any(random, -shift, shift) * rho, any(random, -shift, shift) * rho,
                any(random, -50, 50)};
  cone.direction = direction(random, closed ? 0.6 : 0.9);
  return cone;
}

template <class Shape>
void expect_ray(const Shape& shape, double rho, double& worst, int& met, int& missed) {
  const auto f = outside(shape);
  const auto prepared = prepare(Cutter(shape));
  ASSERT_TRUE(prepared);
  const Solid solid{Cutter(shape)};
  for (int k = 0; k < kPhases; ++k) {
    const double phi = kTwoPi * (k + 0.31) / kPhases;
    const auto want = top(f, rho, phi);
    if (std::abs(want.deepest) < 1e-9L) continue;
    const auto line = generator_at(rho, phi);
    const auto got = hit(*prepared, line);
    ASSERT_EQ(got.has_value(), want.deepest < 0) << phi << ' ' << static_cast<double>(want.deepest);
    const auto proof = solid.top(rho * line.cos_phi, rho * line.sin_phi);
    ASSERT_EQ(proof.has_value(), got.has_value());
    if (!got) {
      ++missed;
      continue;
    }
    ++met;
    const double off = static_cast<double>(std::abs(want.z - got->z));
    worst = std::max(worst, off);
    EXPECT_LT(off, kTolerance) << phi;
    EXPECT_NEAR(*proof, got->z, kTolerance);
    EXPECT_NEAR(got->normal.norm(), 1.0, 1e-9);
    const Eigen::Vector3d at(rho * line.cos_phi, rho * line.sin_phi, got->z);
    const Eigen::Vector3d global(got->normal.x() * line.cos_phi - got->normal.y() * line.sin_phi,
                                 got->normal.x() * line.sin_phi + got->normal.y() * line.cos_phi,
                                 got->normal.z());
    EXPECT_LT((solid.normal(at) - global).norm(), 1e-6) << phi;
    // Derivatives by differences, away from silhouettes and seams.
    if (got->normal.z() < 0.2) continue;
    const double h = 1e-4;
    const auto before = hit(*prepared, generator_at(rho, phi - h));
    const auto after = hit(*prepared, generator_at(rho, phi + h));
    if (!before || !after) continue;
    const double bent = before->z_dphi - 2 * got->z_dphi + after->z_dphi;
    if (std::abs(bent) > 1e-6 * rho) continue;
    EXPECT_NEAR((after->z - before->z) / (2 * h), got->z_dphi, 1e-4 * rho) << phi;
  }
}

TEST(Shapes, BoxesAndConesAgreeWithTheRayCaster) {
  std::mt19937_64 random(kSeed);
  std::cout << "seed " << kSeed << '\n';
  for (const bool box : {true, false}) {
    double worst = 0.0;
    int met = 0, missed = 0, placed = 0;
    while (placed < kPlacements) {
      const double rho = any(random, 10, 120);
      if (box) {
        expect_ray(random_box(random, rho, false), rho, worst, met, missed);
      } else {
        const auto cone = random_cone(random, rho, false);
        if (!prepare(Cutter(cone))) continue;  // the target runs inside its opening
        expect_ray(cone, rho, worst, met, missed);
      }
      ++placed;
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(met, placed * kPhases / 4);
    EXPECT_GT(missed, placed);
    std::cout << (box ? "box " : "cone ") << placed << " placements, " << met << " met, " << missed
              << " missed, worst height " << worst << " mm\n";
  }
}

ElbowCutter random_elbow(std::mt19937_64& random, double rho) {
  ElbowCutter elbow;
  elbow.radius = rho * any(random, 0.4, 1.5);
  elbow.bend_radius = elbow.radius * any(random, 1.3, 5.0);
  elbow.bend = Angle::deg(any(random, 20, 180));
  elbow.point = {any(random, -1.5, 1.5) * rho, any(random, -1.5, 1.5) * rho, any(random, -50, 50)};
  elbow.direction = direction(random, 1.0);
  elbow.inwards = {any(random, -1, 1), any(random, -1, 1), any(random, -1, 1)};
  return elbow;
}

TEST(Shapes, ElbowsAgreeWithTheRayCaster) {
  std::mt19937_64 random(kSeed + 2);
  double worst = 0.0;
  int placed = 0, met = 0, missed = 0;
  while (placed < kPlacements) {
    const double rho = any(random, 10, 60);
    const auto elbow = random_elbow(random, rho);
    const auto prepared = prepare(Cutter(elbow));
    if (!prepared || sin_inclination(*prepared) < 0.1) continue;
    ++placed;
    const auto f = outside(elbow);
    const Solid solid{Cutter(elbow)};
    for (int k = 0; k < 24; ++k) {
      const double phi = kTwoPi * (k + 0.31) / 24;
      const auto want = marched(f, rho, phi);
      if (std::abs(want.deepest) < 1e-8L && want.deepest > 0) continue;
      const auto line = generator_at(rho, phi);
      const auto got = hit(*prepared, line);
      ASSERT_EQ(got.has_value(), want.deepest <= 0)
          << placed << ' ' << phi << ' ' << static_cast<double>(want.deepest);
      if (!got) {
        ++missed;
        continue;
      }
      ++met;
      const double off = static_cast<double>(std::abs(want.z - got->z));
      if (got->normal.z() > 1e-4) worst = std::max(worst, off);
      EXPECT_LT(off, got->normal.z() > 1e-4 ? kTolerance : 1e-3) << placed << ' ' << phi;
      const Eigen::Vector3d at(rho * line.cos_phi, rho * line.sin_phi, got->z);
      EXPECT_NEAR(solid.distance(at), 0.0, 1e-10 * (1.0 + std::abs(got->z)));
      if (got->normal.z() < 0.2) continue;
      const double h = 1e-4;
      const auto before = hit(*prepared, generator_at(rho, phi - h));
      const auto after = hit(*prepared, generator_at(rho, phi + h));
      if (!before || !after) continue;
      const double bent = before->z_dphi - 2 * got->z_dphi + after->z_dphi;
      if (std::abs(bent) > 1e-6 * rho) continue;
      EXPECT_NEAR((after->z - before->z) / (2 * h), got->z_dphi, 1e-4 * rho) << phi;
    }
  }
  std::cout << "elbow " << placed << " placements, " << met << " met, " << missed
            << " missed, worst height " << worst << " mm\n";
  EXPECT_GT(met, placed * 6);
  EXPECT_GT(missed, placed);
}

TEST(Shapes, ElbowEventsOnScans) {
  std::mt19937_64 random(kSeed + 3);
  int changes = 0, refused = 0, traced = 0;
  for (int n = 0; n < 12; ++n) {
    const double rho = any(random, 20, 60);
    const std::vector<Cutter> cutters{TubeCutter{.radius = 1.6 * rho,
                                                 .inclination = Angle::deg(any(random, 50, 130)),
                                                 .clocking = Angle::deg(any(random, 0, 360)),
                                                 .offset = any(random, -0.5, 0.5) * rho},
                                      random_elbow(random, rho), random_box(random, rho, false)};
    const auto contour = trace(cutters, rho);
    if (!contour) {
      EXPECT_EQ(contour.error().code(), ErrorCode::unsupported_combination);
      ++refused;
      continue;
    }
    ++traced;
    std::vector<Outside> bodies{outside(std::get<TubeCutter>(cutters[0])),
                                outside(std::get<ElbowCutter>(cutters[1])),
                                outside(std::get<RectangularTubeCutter>(cutters[2]))};
    std::size_t last = contour->segments.back().cutter;
    constexpr int kFew = 360;
    const double step = kTwoPi / kFew;
    for (int k = 0; k < kFew; ++k) {
      const double phi = step * (k + 0.5);
      Real z = -1e9L, second = -1e9L;
      std::size_t best = 0;
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const auto one = i == 1 ? marched(bodies[i], rho, phi) : top(bodies[i], rho, phi);
        if (one.deepest > 0) continue;
        if (one.z > z) {
          second = z;
          z = one.z;
          best = i;
        } else {
          second = std::max(second, one.z);
        }
      }
      if (z - second < 1e-5L) best = segment_at(*contour, phi).cutter;
      EXPECT_EQ(segment_at(*contour, phi).cutter, best) << n << ' ' << phi;
      if (best != last) ++changes;
      last = best;
    }
  }
  std::cout << traced << " traced, " << refused << " refused, " << changes << " changes\n";
  EXPECT_GT(traced, 6);
  EXPECT_GT(changes, 10);
}

// A hairpin whose upper leg lies next to the lower one: at the upper one's side z would jump to the
// lower one, from the partner to itself.
TEST(Shapes, AnElbowThatHidesItselfIsRefused) {
  const std::vector<Cutter> cutters{ElbowCutter{.radius = 50,
                                                .bend_radius = 80,
                                                .bend = Angle::deg(180),
                                                .point = {-300, 0, 0},
                                                .direction = {-1, 0, 0},
                                                .inwards = {0, 0.4, 1}},
                                    PlaneCutter{{0, 0, -100}, {0, 0, 1}}};
  const auto contour = trace(cutters, 60.0);
  ASSERT_FALSE(contour);
  EXPECT_EQ(contour.error().code(), ErrorCode::unsupported_combination);
  EXPECT_EQ(contour.error().issues.front().member, "cutters/0");
  // With the bend's plane upright only the upper leg is seen.
  auto upright = cutters;
  std::get<ElbowCutter>(upright[0]).inwards = {0, 0, 1};
  EXPECT_TRUE(trace(upright, 60.0));
}

TEST(Shapes, NoEventMissedNoneExtraOnScans) {
  std::mt19937_64 random(kSeed + 1);
  int changes = 0, events = 0;
  for (int n = 0; n < 40; ++n) {
    const double rho = any(random, 20, 80);
    std::vector<Cutter> cutters;
    std::vector<Outside> bodies;
    const auto add = [&](const auto& one) {
      cutters.emplace_back(one);
      bodies.push_back(outside(one));
    };
    if (n % 2 == 0)
      add(random_box(random, rho, true));
    else
      add(random_cone(random, rho, true));
    add(random_box(random, rho, false));
    auto cone = random_cone(random, rho, false);
    cone.half_angle = Angle::deg(any(random, -20, 20));
    cone.direction.z() *= 0.5;
    add(cone);
    add(TubeCutter{.radius = any(random, 0.3, 1.2) * rho,
                   .inclination = Angle::deg(any(random, 30, 150)),
                   .clocking = Angle::deg(any(random, 0, 360)),
                   .offset = any(random, -1, 1) * rho,
                   .height = any(random, -30, 30)});
    if (n % 4 == 0) add(PlaneCutter{{0, 0, any(random, 0, 80)}, {any(random, -0.5, 0.5), 0.2, 1}});
    const auto contour = trace(cutters, rho);
    ASSERT_TRUE(contour) << n;
    const auto near_event = [&](double phi, double reach) {
      return std::ranges::any_of(contour->events, [&](const Event& e) {
        const double d = std::abs(e.phi - phi);
        return std::min(d, kTwoPi - d) < reach;
      });
    };
    // The scan is by the solids, whose formulas are others than the contour's.
    std::vector<Solid> solids;
    for (const auto& c : cutters) solids.emplace_back(c);
    std::size_t last = contour->segments.back().cutter;
    const double step = kTwoPi / kScan;
    for (int k = 0; k < kScan; ++k) {
      const double phi = step * (k + 0.5);
      double z = -1e300, second = -1e300;
      std::size_t best = 0;
      for (std::size_t i = 0; i < solids.size(); ++i) {
        const auto one = solids[i].top(rho * std::cos(phi), rho * std::sin(phi));
        if (!one) continue;
        if (*one > z) {
          second = z;
          z = *one;
          best = i;
        } else {
          second = std::max(second, *one);
        }
      }
      const auto said = segment_at(*contour, phi).cutter;
      if (z - second > 1e-6 && !near_event(phi, 1e-7)) {
        EXPECT_EQ(said, best) << n << ' ' << phi;
      } else {
        best = said;
      }
      if (best != last) {
        ++changes;
        EXPECT_TRUE(near_event(phi - 0.5 * step, 0.5 * step + 1e-9)) << n << ' ' << phi;
      }
      last = best;
    }
    for (const auto& event : contour->events) {
      ++events;
      EXPECT_NE(event.from, event.to) << n;
      double reach = 1e-5;
      for (const auto& other : contour->events) {
        const double d = std::abs(other.phi - event.phi);
        if (&other != &event) reach = std::min(reach, 0.3 * std::min(d, kTwoPi - d));
      }
      const auto leads = [&](double phi, std::size_t who) {
        const auto own = top(bodies[who], rho, phi);
        for (const auto& body : bodies) {
          const auto other = top(body, rho, phi);
          if (other.deepest < -1e-9L && other.z > own.z + 1e-7L) return false;
        }
        return own.deepest < 1e-9L;
      };
      EXPECT_TRUE(leads(event.phi - reach, event.from)) << n << ' ' << event.phi;
      EXPECT_TRUE(leads(event.phi + reach, event.to)) << n << ' ' << event.phi;
    }
    if (HasFailure()) return;
  }
  std::cout << changes << " changes, " << events << " events\n";
  EXPECT_GT(changes, 60);
}

TEST(Shapes, ARoundBoxAndAStraightConeAreTubes) {
  const double rho = 30.0;
  const TubeCutter tube{.radius = 50.0, .inclination = Angle::deg(90)};  // along -y
  RectangularTubeCutter box{.width = 100,
                            .height = 100,
                            .corner = 50,
                            .point = {0, 0, 0},
                            .direction = {0, -1, 0},
                            .up = {0.3, 0, 1}};
  ConeCutter cone{.radius = 50, .half_angle = {}, .point = {0, 7, 0}, .direction = {0, -2, 0}};
  const auto want = prepare(Cutter(tube));
  for (const Cutter& other : {Cutter(box), Cutter(cone)}) {
    const auto got = prepare(other);
    ASSERT_TRUE(got);
    for (int k = 0; k < 360; ++k) {
      const auto line = generator_at(rho, k * kRadPerDeg);
      const auto a = hit(*want, line), b = hit(*got, line);
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->z, b->z, 1e-12);
      EXPECT_LT((a->normal - b->normal).norm(), 1e-13);
      EXPECT_NEAR(a->z_dphi, b->z_dphi, 1e-11);
    }
  }
}

TEST(Shapes, ImpossiblePartnersAreNamed) {
  const auto code = [](const Cutter& cutter) {
    const auto made = under("cutters/0", prepare(cutter));
    return made ? std::string("ok")
                : std::string(info(made.error().code()).code) + " " +
                      made.error().issues.front().member;
  };
  RectangularTubeCutter box{.width = 80, .height = 60, .corner = 5};
  EXPECT_EQ(code(box), "ok");
  box.corner = 0;
  EXPECT_EQ(code(box), "out_of_range cutters/0/corner_radius");
  box.corner = 31;
  EXPECT_EQ(code(box), "out_of_range cutters/0/corner_radius");
  box.corner = 30;
  EXPECT_EQ(code(box), "ok");
  box.up = {2, 0, 0};
  EXPECT_EQ(code(box), "bad_reference_direction cutters/0/up");
  box.up = {0, 1, 0};
  box.direction = {0, 0, 1};
  EXPECT_EQ(code(box), "parallel_axes cutters/0");
  box.direction = {0, 0, 0};
  EXPECT_EQ(code(box), "zero_length cutters/0/axis");
  ConeCutter cone{.radius = 50, .half_angle = Angle::deg(30), .direction = {1, 0, 0}};
  EXPECT_EQ(code(cone), "ok");
  cone.direction = {1, 0, 2};  // 26.6 deg from the target, inside its opening
  EXPECT_EQ(code(cone), "parallel_axes cutters/0");
  cone.direction = {1, 0, -2};
  EXPECT_EQ(code(cone), "parallel_axes cutters/0");
  ElbowCutter elbow{.radius = 50, .bend_radius = 75};
  EXPECT_EQ(code(elbow), "ok");  // it ends upright: of which target that is refused, see elbow_leg
  elbow.bend = Angle::deg(45);
  EXPECT_EQ(code(elbow), "ok");
  elbow.bend_radius = 50;
  EXPECT_EQ(code(elbow), "out_of_range cutters/0/bend_radius");
  elbow.bend_radius = 75;
  elbow.inwards = {1, 0, 0};
  EXPECT_EQ(code(elbow), "bad_reference_direction cutters/0/inwards");
  cone.half_angle = Angle::deg(85);
  EXPECT_EQ(code(cone), "out_of_range cutters/0/half_angle");
}

}  // namespace
}  // namespace tubecut::joint
