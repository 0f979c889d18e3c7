// Degenerate joints, and laws that hold whatever the numbers are.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/joint/contour.hpp"
#include "core/joint/length.hpp"
#include "core/joint/placement.hpp"
#include "core/joint/sampling.hpp"
#include "tests/core/joint/published.hpp"
#include "tests/core/joint/random_nodes.hpp"

namespace tubecut::joint {
namespace {

Result<Contour> trace_one(const TubeCutter& tube, double rho) {
  return trace(std::vector<Cutter>{tube}, rho);
}

Intervals open_of(const Result<Contour>& result) {
  EXPECT_FALSE(result);
  EXPECT_EQ(result.error().code(), ErrorCode::open_profile);
  EXPECT_EQ(result.error().issues.front().member, "cutters");
  return std::get<Intervals>(result.error().issues.front().got);
}

TEST(Cases, EqualRadiiAtRightAnglesAreTwoPlanarEllipses) {
  const auto contour = trace_one(tube_deg(40, 90, 30, 0), 40);
  ASSERT_TRUE(contour);
  ASSERT_EQ(contour->events.size(), 2U);
  for (const auto& event : contour->events) EXPECT_EQ(event.kind, EventKind::kink);
  EXPECT_NEAR(contour->events[0].phi * kDegPerRad, 30, 1e-10);
  EXPECT_NEAR(contour->events[1].phi * kDegPerRad, 210, 1e-10);
  for (double degree = 0; degree < 360; degree += 0.5) {
    const double phi = degree * kRadPerDeg;
    EXPECT_NEAR(contact_at(*contour, phi).z, 40 * std::abs(std::sin(phi - 30 * kRadPerDeg)), 1e-13);
  }
  // Each half is half an ellipse of half axes 40 and 40 sqrt(2), from narrow end to narrow end.
  const double ellipse = 4.0 * 40.0 * std::sqrt(2.0) * std::comp_ellint_2(std::sqrt(0.5));
  EXPECT_NEAR(true_length(*contour), ellipse, 1e-9);
}

TEST(Cases, NearlyEqualRadii) {
  const double little = 1e-9;
  const auto wide = trace_one(tube_deg(40 * (1 + little), 70, 10, 0), 40);
  EXPECT_TRUE(wide);
  const auto narrow = open_of(trace_one(tube_deg(40 * (1 - little), 70, 10, 0), 40));
  ASSERT_EQ(narrow.size(), 2U);
  const double half = std::sqrt(2 * little) * kDegPerRad;  // acos(1 - little)
  EXPECT_NEAR(0.5 * (narrow[0].second - narrow[0].first), half, 1e-6 * half);
  EXPECT_NEAR(narrow[0].first, 10 - half, 1e-9);
  EXPECT_NEAR(narrow[1].first, 190 - half, 1e-9);
  // Rounding of an axis that meets the target's is no gap.
  EXPECT_TRUE(trace_one(tube_deg(40, 70, 10, 3e-15), 40));
  EXPECT_TRUE(trace_one(tube_deg(40, 70, 10, -3e-15), 40));
}

TEST(Cases, TangentTubesHaveOneCorner) {
  for (const double side : {1.0, -1.0}) {
    const auto contour = trace_one(tube_deg(50, 60, 100, side * 15), 35);
    ASSERT_TRUE(contour);
    ASSERT_EQ(contour->events.size(), 1U);
    const auto& event = contour->events.front();
    EXPECT_EQ(event.kind, EventKind::kink);
    EXPECT_EQ(event.from, event.to);
    EXPECT_NEAR(event.phi * kDegPerRad, side > 0 ? 100 : 280, 1e-10);
    EXPECT_NEAR(event.z_from, 0.0, 1e-5);
  }
}

TEST(Cases, IdenticalCuttersHaveNoJunction) {
  const auto a = tube_deg(50, 60, 100, 10, 3);
  const auto turned = tube_deg(50, 120, 280, -10, 3);  // the same axis from its other end
  const auto contour = trace(std::vector<Cutter>{a, turned, a}, 35);
  ASSERT_TRUE(contour);
  EXPECT_TRUE(contour->events.empty());
  for (double phi = 0; phi < kTwoPi; phi += 0.01) EXPECT_EQ(contact_at(*contour, phi).cutter, 0U);
}

TEST(Cases, NearlyIdenticalCuttersStillHaveTheirJunctions) {
  const auto a = tube_deg(50, 60, 100, 10, 3);
  const auto b = tube_deg(50, 60, 100, 10 + 1e-7, 3);
  const auto contour = trace(std::vector<Cutter>{a, b}, 35);
  ASSERT_TRUE(contour);
  ASSERT_EQ(contour->events.size(), 2U);
  for (double phi = 0.0005; phi < kTwoPi; phi += 0.001) {
    const auto za = upper_sheet(a, 35, Angle::rad(phi));
    const auto zb = upper_sheet(b, 35, Angle::rad(phi));
    if (std::abs(*za - *zb) < 1e-12) continue;
    EXPECT_EQ(segment_at(*contour, phi).cutter, *za > *zb ? 0U : 1U) << phi;
  }
}

TEST(Cases, NoContactAndPartialContact) {
  const auto far = tube_deg(20, 80, 0, 56);
  const auto none = trace_one(far, 35);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code(), ErrorCode::no_contact);
  // X = u + 30 within +-20 leaves u in [-35, -10]: open where cos(phi) > -10/35.
  const auto open = open_of(trace_one(tube_deg(20, 80, 0, 30), 35));
  ASSERT_EQ(open.size(), 1U);
  const double border = std::acos(-10.0 / 35.0) * kDegPerRad;
  EXPECT_NEAR(open[0].first, 360 - border, 1e-10);
  EXPECT_NEAR(open[0].second, 360 + border, 1e-10);
  // One missed and one hit is a warning's matter; a plane closes the gap with two jumps.
  const auto closed = trace(
      std::vector<Cutter>{far, tube_deg(20, 80, 0, 30), PlaneCutter{{0, 0, -50}, {0, 0, -1}}}, 35);
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->missed, std::vector<std::size_t>{0});
  ASSERT_EQ(closed->events.size(), 2U);
  for (const auto& event : closed->events) EXPECT_EQ(event.kind, EventKind::jump);
  EXPECT_NEAR(closed->events[0].phi * kDegPerRad, border, 1e-10);
  EXPECT_EQ(closed->events[0].from, 2U);
  EXPECT_EQ(closed->events[0].to, 1U);
  EXPECT_DOUBLE_EQ(closed->events[0].z_from, -50);
}

TEST(Cases, BranchLargerThanChordIsOpenOnBothSides) {
  EXPECT_EQ(open_of(trace_one(tube_deg(30, 75, 20, 0), 35)).size(), 2U);
}

TEST(Cases, TangentByAHairHasTheLengthOfTheTangentCut) {
  const auto length = [](double offset) {
    const auto contour = trace_one(tube_deg(2.5, 55, 151.2, offset), 2.5);
    return contour ? true_length(*contour) : 0.0;
  };
  for (const double offset : {1e-13, -1e-13, 1e-12, -1e-12})
    EXPECT_NEAR(length(offset), length(0.0), 1e-5) << offset;
}

TEST(Cases, ParallelAxes) {
  for (const double inclination : {0.0, 5e-5, 180 - 5e-5, -3.0, 180.0}) {
    const auto result = trace_one(tube_deg(50, inclination, 0, 0), 35);
    ASSERT_FALSE(result) << inclination;
    EXPECT_EQ(result.error().code(), ErrorCode::parallel_axes);
    EXPECT_EQ(result.error().issues.front().member, "cutters/0/inclination");
    EXPECT_NEAR(std::get<double>(result.error().issues.front().limit), 5.73e-5, 1e-7);
  }
  const auto near = trace_one(tube_deg(60, 4.9, 0, 0), 35);
  ASSERT_TRUE(near);
  EXPECT_EQ(near->near_parallel, std::vector<std::size_t>{0});
  EXPECT_TRUE(trace_one(tube_deg(60, 5.1, 0, 0), 35)->near_parallel.empty());
  const auto plane = trace(std::vector<Cutter>{PlaneCutter{{0, 0, 0}, {1, 0, 1e-7}}}, 35);
  ASSERT_FALSE(plane);
  EXPECT_EQ(plane.error().code(), ErrorCode::parallel_axes);
}

TEST(Cases, EveryWrongCutterIsNamed) {
  const auto result = trace(std::vector<Cutter>{tube_deg(-1, 80, 0, 0), tube_deg(50, 80, 0, 0),
                                                PlaneCutter{{0, 0, 0}, {0, 0, 0}}},
                            35);
  ASSERT_FALSE(result);
  ASSERT_EQ(result.error().issues.size(), 2U);
  EXPECT_EQ(result.error().issues[0].code, ErrorCode::out_of_range);
  EXPECT_EQ(result.error().issues[0].member, "cutters/0/radius");
  EXPECT_EQ(result.error().issues[1].code, ErrorCode::zero_length);
  EXPECT_EQ(result.error().issues[1].member, "cutters/2/normal");
  EXPECT_EQ(trace(std::vector<Cutter>{}, 35).error().code(), ErrorCode::wrong_count);
}

TEST(Cases, TwoPlanesMeetInTwoJunctions) {
  const auto contour = trace(std::vector<Cutter>{PlaneCutter{{0, 0, 5}, {0.3, 0, 1}},
                                                 PlaneCutter{{0, 0, 5}, {-0.3, 0, 1}}},
                             35);
  ASSERT_TRUE(contour);
  ASSERT_EQ(contour->events.size(), 2U);
  EXPECT_NEAR(contour->events[0].phi * kDegPerRad, 90, 1e-10);
  EXPECT_NEAR(contour->events[1].phi * kDegPerRad, 270, 1e-10);
  EXPECT_EQ(contour->events[0].from, 1U);
  EXPECT_EQ(contour->events[0].to, 0U);
}

std::vector<Cutter> turned(std::vector<Cutter> cutters, double degree) {
  for (auto& cutter : cutters) {
    auto& tube = std::get<TubeCutter>(cutter);
    tube.clocking = tube.clocking + Angle::deg(degree);
  }
  return cutters;
}

TEST(Laws, TurningEveryCutterTurnsTheProfile) {
  std::mt19937_64 random(11);
  for (int n = 0; n < 30; ++n) {
    const auto node = random_node(random, true, n % 3 == 0, false);
    const auto one = trace(node.cutters, node.rho);
    const auto other = trace(turned(node.cutters, 77), node.rho);
    ASSERT_TRUE(one && other);
    ASSERT_EQ(one->events.size(), other->events.size());
    EXPECT_NEAR(true_length(*one), true_length(*other), 1e-9 * true_length(*one));
    for (double phi = 0.003; phi < kTwoPi; phi += 0.1) {
      double there = phi + 77 * kRadPerDeg;
      if (there >= kTwoPi) there -= kTwoPi;
      EXPECT_NEAR(contact_at(*one, phi).z, contact_at(*other, there).z, 1e-9);
    }
  }
}

TEST(Laws, ScalingByPowersOfTwoIsExact) {
  std::mt19937_64 random(12);
  for (int n = 0; n < 30; ++n) {
    const auto node = random_node(random, true, n % 3 == 0, n % 2 == 0);
    const auto one = trace(node.cutters, node.rho);
    ASSERT_TRUE(one);
    for (const double k : {0.25, 8.0, 1024.0}) {
      auto cutters = node.cutters;
      for (auto& cutter : cutters) {
        if (auto* plane = std::get_if<PlaneCutter>(&cutter)) {
          plane->point *= k;
          continue;
        }
        auto& tube = std::get<TubeCutter>(cutter);
        tube.radius *= k;
        tube.offset *= k;
        tube.height *= k;
      }
      const auto other = trace(cutters, k * node.rho);
      ASSERT_TRUE(other);
      ASSERT_EQ(one->events.size(), other->events.size());
      for (std::size_t i = 0; i < one->events.size(); ++i) {
        EXPECT_EQ(one->events[i].phi, other->events[i].phi);
        EXPECT_EQ(k * one->events[i].z_from, other->events[i].z_from);
        EXPECT_EQ(k * one->events[i].z_to, other->events[i].z_to);
      }
      for (double phi = 0.003; phi < kTwoPi; phi += 0.1)
        EXPECT_EQ(k * contact_at(*one, phi).z, contact_at(*other, phi).z);
      EXPECT_EQ(k * true_length(*one), true_length(*other));
    }
  }
}

TEST(Laws, TheSameAxisFromItsOtherEnd) {
  std::mt19937_64 random(13);
  for (int n = 0; n < 100; ++n) {
    const auto node = random_node(random, true, false, false);
    const auto& tube = std::get<TubeCutter>(node.cutters.front());
    auto other = tube;
    other.inclination = Angle::rad(kPi) - tube.inclination;
    other.clocking = tube.clocking + Angle::rad(kPi);
    other.offset = -tube.offset;
    for (double phi = 0.003; phi < kTwoPi; phi += 0.1) {
      const auto a = hit(tube, node.rho, Angle::rad(phi));
      const auto b = hit(other, node.rho, Angle::rad(phi));
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->z, b->z, 1e-12 * (tube.radius + node.rho) / std::sin(tube.inclination.rad()));
      EXPECT_NEAR(a->axial, -b->axial, 1e-10);
      EXPECT_NEAR((a->normal - b->normal).norm(), 0, 1e-12 / a->normal.z());
    }
  }
}

TEST(Laws, DerivativesAgainstTheOracle) {
  std::mt19937_64 random(14);
  for (int n = 0; n < 100; ++n) {
    const auto node = random_node(random, true, false, true);
    for (std::size_t i = 0; i < node.cutters.size(); ++i) {
      for (double phi = 0.003; phi < kTwoPi; phi += 0.37) {
        const auto got = hit(node.cutters[i], node.rho, Angle::rad(phi));
        if (!got || got->normal.z() < 0.2) continue;
        const ray::Real step = 1e-5L;
        const auto z = [&](int k) {
          return ray::top(node.bodies[i], node.rho, static_cast<ray::Real>(phi) + k * step)
              .value_or(0);
        };
        const auto slope = static_cast<double>((z(1) - z(-1)) / (2 * step));
        EXPECT_NEAR(got->z_dphi, slope, 1e-5 + 1e-6 * std::abs(slope));
      }
    }
  }
}

TEST(Laws, PointsLieOnTheCutter) {
  std::mt19937_64 random(15);
  double worst = 0.0;
  for (int n = 0; n < 200; ++n) {
    const auto node = random_node(random, false, n % 3 == 0, false);
    for (std::size_t i = 0; i < node.cutters.size(); ++i) {
      const double radius = std::get<TubeCutter>(node.cutters[i]).radius;
      for (double phi = 0.003; phi < kTwoPi; phi += 0.05) {
        const auto z = upper_sheet(node.cutters[i], node.rho, Angle::rad(phi));
        if (!z) continue;
        const ray::Point p{node.rho * std::cos(static_cast<ray::Real>(phi)),
                           node.rho * std::sin(static_cast<ray::Real>(phi)), *z};
        const auto off = std::abs(ray::outside(node.bodies[i], p)) / (2 * radius);
        worst = std::max(worst, static_cast<double>(off) / (radius + node.rho));
      }
    }
  }
  std::cout << "off the cutter by " << worst << " of radius + rho\n";
  EXPECT_LT(worst, 1e-12);
}

TEST(Placement, AxisRoundTripAndReversal) {
  std::mt19937_64 random(16);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 500; ++n) {
    const Eigen::Vector3d point = 500 * Eigen::Vector3d(any(random), any(random), any(random));
    const Eigen::Vector3d direction = Eigen::Vector3d(any(random), any(random), any(random));
    if (std::hypot(direction.x(), direction.y()) < 0.05) continue;
    const auto placed = place({point, direction}, 40);
    ASSERT_TRUE(placed);
    const auto axis = axis_of(placed->tube);
    const Eigen::Vector3d back = axis.point + placed->point_axial * axis.direction;
    const double size =
        point.norm() + std::abs(placed->tube.height) + std::abs(placed->point_axial);
    EXPECT_LT((back - point).norm(), 1e-13 * size);
    EXPECT_LT((axis.direction - direction.normalized()).norm(), 1e-15);
    const auto reversed = place({point, -direction}, 40);
    ASSERT_TRUE(reversed);
    EXPECT_NEAR(reversed->tube.offset, -placed->tube.offset, 1e-12);
    EXPECT_NEAR(reversed->tube.inclination.rad(), kPi - placed->tube.inclination.rad(), 1e-15);
    EXPECT_NEAR(reversed->tube.height, placed->tube.height, 1e-13 * size);
  }
}

TEST(Placement, Errors) {
  const auto code = [](const auto& result) { return result.error().code(); };
  EXPECT_EQ(code(place({{1, 2, 3}, {0, 0, 0}}, 40)), ErrorCode::zero_length);
  EXPECT_EQ(code(place({{1, 2, 3}, {9e-7, 0, -1}}, 40)), ErrorCode::parallel_axes);
  EXPECT_TRUE(place({{1, 2, 3}, {1.1e-6, 0, -1}}, 40));
  const Eigen::Vector3d o = Eigen::Vector3d::Zero();
  const Eigen::Vector3d z = {0, 0, 100};
  EXPECT_EQ(code(member_frame(o, o, {1, 0, 0})), ErrorCode::zero_length);
  EXPECT_EQ(code(member_frame(o, z, o)), ErrorCode::zero_length);
  EXPECT_EQ(code(member_frame(o, z, {0, 0, -3})), ErrorCode::bad_reference_direction);
}

// Source 000's phase zero: the chord gets clocking 0.
TEST(Placement, ChordReferenceGivesClockingZero) {
  const Eigen::Vector3d far{300, 400, 1200};
  const Eigen::Vector3d chord{1, -0.4, 0.3};
  const auto frame = member_frame({0, 0, 0}, far, chord_reference(far, chord));
  ASSERT_TRUE(frame);
  const auto placed = place(frame->local(AxisLine{{0, 0, 0}, chord}), 100);
  ASSERT_TRUE(placed);
  EXPECT_NEAR(std::sin(placed->tube.clocking.rad()), 0, 1e-14);
  EXPECT_NEAR(std::cos(placed->tube.clocking.rad()), 1, 1e-14);
}

}  // namespace
}  // namespace tubecut::joint
