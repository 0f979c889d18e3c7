#include "core/joint/length.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "core/joint/borders.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

 private:
  std::mt19937_64 engine_;
};

/// The length of straight lines between very many points of the sheet itself.
double polyline(const Cutter& cutter, double rho, int count) {
  const auto prepared = prepare(cutter);
  EXPECT_TRUE(prepared);
  double out = 0.0;
  Vector3d before = Vector3d::Zero();
  for (int k = 0; k <= count; ++k) {
    const double phi = 2.0 * std::numbers::pi * k / count;
    const auto line = generator_at(rho, phi);
    const auto z = upper_sheet(*prepared, line);
    EXPECT_TRUE(z);
    const Vector3d at(rho * line.cos_phi, rho * line.sin_phi, *z);
    if (k > 0) out += (at - before).norm();
    before = at;
  }
  return out;
}

/// A round end on a box whose narrow corner is met all the way across, between rows.
RectangularTubeCutter box(Draw& draw, double rho) {
  const double lean = draw.any(-0.6, 0.6), tilt = draw.any(0.1, 1.4);
  const Vector3d along(std::cos(lean), 0.0, std::sin(lean));
  const Vector3d across = along.unitOrthogonal();
  return {.width = draw.any(3.0, 6.0) * rho,
          .height = draw.any(3.0, 6.0) * rho,
          .corner = draw.any(0.15, 2.0),
          .point = {draw.any(-50, 50), draw.any(-0.4, 0.4) * rho, draw.any(-50, 50)},
          .direction = along,
          .up = Eigen::AngleAxisd(tilt, along) * across};
}

/// An elbow whose bend is little wider than its tube: its inner side is narrow.
ElbowCutter elbow(Draw& draw, double rho) {
  const double radius = draw.any(1.5, 2.5) * rho;
  return {.radius = radius,
          .bend_radius = draw.any(1.02, 1.6) * radius,
          .bend = Angle::deg(draw.any(5, 60)),
          .point = {draw.any(-0.5, 0.5) * rho, draw.any(-0.2, 0.2) * rho, 0.0},
          .direction = Vector3d(1.0, draw.any(-0.2, 0.2), draw.any(-0.2, 0.2)).normalized(),
          .inwards = Vector3d(0.0, draw.any(-0.4, 0.4), 1.0)};
}

/// Rows and the whole, and rotated rows, have one length: that of the polyline.
void hold(const Cutter& cutter, double rho, int count, double bound, double& worst) {
  const auto contour = trace(std::array{cutter}, rho);
  ASSERT_TRUE(contour);
  const double want = polyline(cutter, rho, count), whole = true_length(*contour);
  for (const int rows : {0, 36, 72, 97}) {
    std::vector<double> phases;
    for (int k = 0; k < rows; ++k) phases.push_back(2.0 * std::numbers::pi * (k + 0.3) / rows);
    const double got = lengths_along(*contour, phases).back();
    EXPECT_NEAR(got, want, bound) << rows << " rows";
    EXPECT_NEAR(got, whole, 1e-9 * whole) << rows << " rows";
    worst = std::max(worst, std::abs(got - want));
  }
}

TEST(Length, NarrowCornersBetweenRows) {
  Draw draw(18);
  double worst = 0.0;
  int held = 0;
  for (int round = 0; round < 200; ++round) {
    const double rho = draw.any(15, 60);
    const auto cutter = box(draw, rho);
    if (met(*prepare(cutter), rho) != Met::always) continue;
    hold(cutter, rho, 40'000, 1e-4, worst);
    ++held;
  }
  std::printf("%d boxes, worst %.2g mm\n", held, worst);
  EXPECT_GT(held, 150);
}

TEST(Length, NarrowBendsBetweenRows) {
  Draw draw(19);
  double worst = 0.0;
  int held = 0;
  for (int round = 0; round < 25; ++round) {
    const double rho = draw.any(15, 60);
    const auto cutter = elbow(draw, rho);
    const auto prepared = prepare(cutter);
    if (!prepared || met(*prepared, rho) != Met::always) continue;
    if (!trace(std::array{Cutter(cutter)}, rho)) continue;  // one that hides itself
    hold(cutter, rho, 6'000, 2e-4, worst);
    ++held;
  }
  std::printf("%d elbows, worst %.2g mm\n", held, worst);
  EXPECT_GT(held, 10);
}

TEST(Length, KindsOfOneSurfaceHaveNoBorders) {
  EXPECT_TRUE(borders(*prepare(TubeCutter{.radius = 60}), 30).empty());
  EXPECT_TRUE(borders(*prepare(PlaneCutter{}), 30).empty());
}

}  // namespace
}  // namespace tubecut::joint
