// The contract of a contour, start point, direction and sector.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/replay/replay.hpp"
#include "tests/core/motion/jobs.hpp"

namespace tubecut::motion::testing {
namespace {

TEST(Refused, ContourThatDoesNotClose) {
  ScheduleSpec spec = table1(0);
  contour_of(spec).z.back() += 1e-3;
  EXPECT_EQ(refusal(spec).code, ErrorCode::not_closed);
  spec = table1(0);
  contour_of(spec).b.back() += 1e-3;
  EXPECT_EQ(refusal(spec).code, ErrorCode::not_closed);
  spec = table1(0);
  for (auto* const column : {&contour_of(spec).phi, &contour_of(spec).z, &contour_of(spec).b}) {
    column->resize(300);
  }
  EXPECT_EQ(refusal(spec).code, ErrorCode::not_closed);
}

TEST(Refused, DuplicatePoint) {
  ScheduleSpec spec = table1(0);
  CutPath& c = contour_of(spec);
  c.phi[7] = c.phi[6];
  c.z[7] = c.z[6];
  c.b[7] = c.b[6];
  const Issue issue = refusal(spec);
  EXPECT_EQ(issue.code, ErrorCode::duplicate_point);
  EXPECT_EQ(issue.member, "contour/phi/7");
}

// Straight back over the way it came, with or without a swing in place there, and across the join.
TEST(Refused, AContourThatTurnsBack) {
  const auto ring = [](std::vector<double> deg, std::vector<double> z, std::vector<double> b,
                       bool closed) {
    ScheduleSpec spec = table1(0);
    CutPath& c = contour_of(spec);
    for (double& one : deg) one *= kRadPerDeg;
    for (double& one : b) one *= kRadPerDeg;
    c.phi = std::move(deg);
    c.z = std::move(z);
    c.b = std::move(b);
    c.closed = closed;
    return spec;
  };
  Issue issue =
      refusal(ring({0, 10, 20, 12, 30, 40}, {0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, false));
  EXPECT_EQ(issue.code, ErrorCode::turns_back);
  EXPECT_EQ(issue.member, "contour/phi/2");
  EXPECT_EQ(
      refusal(ring({0, 10, 20, 20, 12, 2}, {0, 1, 2, 2, 1.2, 0.2}, {0, 0, 0, 9, 0, 0}, false)).code,
      ErrorCode::turns_back);
  // A wedge of a degree is no way back.
  const auto wedge =
      schedule(ring({0, 10, 20, 10, 0}, {0, 0, 0, 0.3, 0.6}, {0, 0, 0, 0, 0}, false));
  EXPECT_TRUE(wedge || wedge.error().code() != ErrorCode::turns_back);
}

TEST(Refused, BadNumbersAndCounts) {
  ScheduleSpec spec = table1(0);
  contour_of(spec).z[3] = std::nan("");
  EXPECT_EQ(refusal(spec).code, ErrorCode::bad_number);
  spec = table1(0);
  contour_of(spec).b[3] = 86 * kRadPerDeg;
  EXPECT_EQ(refusal(spec).code, ErrorCode::angle_out_of_range);
  spec = table1(0);
  contour_of(spec).z.pop_back();
  EXPECT_EQ(refusal(spec).code, ErrorCode::wrong_count);
  spec = table1(0);
  spec.motion.speed = 0.0;
  EXPECT_EQ(refusal(spec).code, ErrorCode::zero_limit);
  spec = table1(0);
  spec.motion.eps_tip = 1e-9;
  EXPECT_EQ(refusal(spec).code, ErrorCode::out_of_range);
}

TEST(Contours, OneTurnMayComeOpen) {
  ScheduleSpec spec = table1(20);
  const Schedule closed = planned(spec);
  for (auto* const column : {&contour_of(spec).phi, &contour_of(spec).z, &contour_of(spec).b}) {
    column->pop_back();
  }
  const Schedule open = planned(spec);
  for (std::size_t a = 0; a < closed.axes.size(); ++a) {
    EXPECT_EQ(closed.axes[a].counts, open.axes[a].counts);
  }
}

/// Torch path rebuilt from the counts.
Replay path_of(const ScheduleSpec& spec) {
  const Schedule s = planned(spec);
  ReplaySpec sent{spec, s.period, {}, {}};
  for (const AxisPulses& axis : s.axes) {
    sent.counts.emplace_back(axis.counts.begin(), axis.counts.end());
    sent.start.push_back(axis.start);
  }
  auto result = replay(sent);
  EXPECT_TRUE(result);
  for (const Check& check : result->invariants)
    EXPECT_TRUE(check.passed()) << check.name << check.value;
  return std::move(*result);
}

/// Largest distance of the points of `a` to the path of `b`, in (radius phi, z); phi modulo turns.
double farthest(const Replay& a, const Replay& b, double radius) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.phi.size(); i += 7) {
    double best = 1e300;
    for (std::size_t j = 0; j + 1 < b.phi.size(); ++j) {
      const double turn = kTwoPi * std::round((a.phi[i] - b.phi[j]) / kTwoPi);
      const double s = radius * (a.phi[i] - turn - b.phi[j]), z = a.z[i] - b.z[j];
      const double ds = radius * (b.phi[j + 1] - b.phi[j]), dz = b.z[j + 1] - b.z[j];
      const double square = ds * ds + dz * dz;
      const double k = square > 0 ? std::clamp((s * ds + z * dz) / square, 0.0, 1.0) : 0.0;
      best = std::min(best, std::hypot(s - k * ds, z - k * dz));
    }
    worst = std::max(worst, best);
  }
  return worst;
}

constexpr double kTwoQuanta = 0.01;  // mm: 2 t_q of the default machine on 70 mm

TEST(Directions, GiveTheSameSurface) {
  for (const int points : {0, 20}) {
    ScheduleSpec spec = table1(points);
    spec.motion.direction = Direction::ccw;
    const Replay ccw = path_of(spec);
    spec.motion.direction = Direction::cw;
    const Replay cw = path_of(spec);
    EXPECT_GT(ccw.phi.back(), ccw.phi.front());
    EXPECT_LT(cw.phi.back(), cw.phi.front());
    EXPECT_LE(farthest(ccw, cw, 35.0), kTwoQuanta);
    EXPECT_LE(farthest(cw, ccw, 35.0), kTwoQuanta);
  }
}

TEST(Sectors, LeftAndRightOfAStopJoinToTheWholeCut) {
  ScheduleSpec spec = table1(20);
  const Replay whole = path_of(spec);
  for (const double stop : {50.0, 137.0, 216.5, 300.0}) {
    spec.motion.sector = Sector{Angle::deg(0), Angle::deg(stop), 0.0};
    const Replay left = path_of(spec);
    spec.motion.sector = Sector{Angle::deg(stop), Angle::deg(360 - 1e-4), 5.0};
    const Replay right = path_of(spec);
    EXPECT_LE(farthest(left, whole, 35.0), spec.motion.eps_tip + kTwoQuanta) << stop;
    EXPECT_LE(farthest(right, whole, 35.0), spec.motion.eps_tip + kTwoQuanta) << stop;
    EXPECT_LT(right.phi.front(), stop * kRadPerDeg - 0.5 * 5.0 / 60.0) << "backed up";
    EXPECT_NEAR(left.phi.back(), stop * kRadPerDeg, 1e-4);
  }
}

TEST(Sectors, ATooShortBackUpIsIgnored) {
  ScheduleSpec spec = table1(20);
  spec.motion.sector = Sector{Angle::deg(50), Angle::deg(200), 0.0};
  const auto none = schedule(spec);
  ASSERT_TRUE(none);
  for (const double back_up : {1e-290, 1e-12, 1e-7}) {
    spec.motion.sector->back_up = back_up;
    const auto out = schedule(spec);
    ASSERT_TRUE(out) << back_up;
    EXPECT_EQ(out->periods, none->periods) << back_up;
    for (const auto& check : verify(spec, *out))
      EXPECT_TRUE(check.passed()) << check.name << " " << back_up;
  }
}

TEST(Starts, AtAnAngle) {
  ScheduleSpec spec = table1(20);
  for (const double phi : {33.0, 33.3, -20.0}) {
    spec.motion.start = {Start::At::phi, Angle::deg(phi)};
    const Replay path = path_of(spec);
    const double turns = (path.phi.front() - phi * kRadPerDeg) / kTwoPi;
    EXPECT_NEAR(turns, std::round(turns), 1e-6);
    EXPECT_NEAR(path.phi.back() - path.phi.front(), kTwoPi, 1e-9);
  }
}

TEST(Starts, AreAtTheUprightTorchByDefault) {
  ScheduleSpec spec = table1(20);
  spec.motion.start.at = Start::At::automatic;
  const Replay path = path_of(spec);
  const auto& b = contour_of(spec).b;
  double least = 1e300;
  for (const double value : b) least = std::min(least, std::abs(value));
  EXPECT_NEAR(std::abs(path.b.front()), least, 1e-6);
}

TEST(Starts, AutomaticallyAwayFromJunctions) {
  ScheduleSpec spec = table1(20);
  CutPath& c = contour_of(spec);
  const auto upright = std::ranges::min_element(c.b, {}, [](double b) { return std::abs(b); });
  const auto i = static_cast<std::size_t>(upright - c.b.begin());
  c.corner.assign(c.phi.size(), false);
  c.corner[i] = true;
  spec.motion.start.at = Start::At::automatic;
  const Replay path = path_of(spec);
  EXPECT_GE(35.0 * std::abs(path.phi.front() - c.phi[i]), 3.0);
}

}  // namespace
}  // namespace tubecut::motion::testing
