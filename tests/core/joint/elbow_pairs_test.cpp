#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/angle.hpp"
#include "core/joint/contour.hpp"
#include "core/joint/cutters/elbow.hpp"

namespace tubecut::joint {
namespace {

ElbowCutter bend(double degrees) {
  return {.radius = 57.15,
          .bend_radius = 152.0,
          .bend = Angle::deg(degrees),
          .point = {0.0, -60.0, 0.0},
          .direction = {0.0, 1.0, 0.4},
          .inwards = {0.0, 0.0, -1.0}};
}

std::vector<Cutter> copies(int n) {
  std::vector<Cutter> out;
  for (int i = 0; i < n; ++i) out.emplace_back(bend(45.0 + 0.1 * i));
  return out;
}

/// Elbows across the target at about one height, so that they take turns on top.
std::vector<Cutter> crowd(std::mt19937_64& random, int n) {
  const auto in = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
  };
  std::vector<Cutter> out;
  for (int i = 0; i < n; ++i) {
    const double turn = in(0.0, kTwoPi), radius = in(35.0, 70.0);
    const double x = std::cos(turn), y = std::sin(turn);
    out.emplace_back(ElbowCutter{.radius = radius,
                                 .bend_radius = radius * in(1.3, 4.0),
                                 .bend = Angle::deg(in(15.0, 120.0)),
                                 .point = {-60.0 * x, -60.0 * y, in(-8.0, 8.0)},
                                 .direction = {x, y, in(-0.5, 0.5)},
                                 .inwards = {in(-0.5, 0.5), in(-0.5, 0.5), -1.0}});
  }
  return out;
}

/// The largest height, away from events, of another cutter above the one that the division names:
/// read cutter by cutter on a grid, without scans, bounds or pairs.
double missed(const Contour& contour, int grid) {
  double worst = 0.0;
  for (int k = 0; k < grid; ++k) {
    const double phi = kTwoPi * (k + 0.37) / grid;
    const bool beside = std::ranges::any_of(contour.events, [&](const Event& event) {
      const double off = std::abs(event.phi - phi);
      return std::min(off, kTwoPi - off) < 1e-7;
    });
    if (beside) continue;
    const auto line = generator_at(contour.radius, phi);
    const double own = continued_sheet(contour.cutters[segment_at(contour, phi).cutter], line);
    for (const auto& cutter : contour.cutters)
      if (const auto z = upper_sheet(cutter, line)) worst = std::max(worst, *z - own);
  }
  return worst;
}

TEST(ElbowPairs, NoEventIsMissedAmongCopies) {
  for (const int n : {2, 3, 8})
    for (const double rho : {26.15, 30.15}) {
      const auto contour = trace(copies(n), rho);
      ASSERT_TRUE(contour);
      EXPECT_LE(missed(*contour, 3607), 1e-6) << n << " " << rho;
    }
}

TEST(ElbowPairs, NoEventIsMissedInACrowd) {
  std::mt19937_64 random(20240607);
  int traced = 0, events = 0;
  for (int i = 0; i < 16; ++i) {
    const auto contour = trace(crowd(random, 2 + i % 5), 28.0);
    if (!contour) continue;
    ++traced;
    events += static_cast<int>(contour->events.size());
    EXPECT_LE(missed(*contour, 3607), 1e-6) << i;
  }
  EXPECT_GE(traced, 6);
  EXPECT_GE(events, 6);
}

// The order of the list only names the cutters.
TEST(ElbowPairs, EventsStayWhenTheListIsTurned) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 4; ++i) {
    auto some = crowd(random, 4);
    const auto one = trace(some, 28.0);
    std::ranges::reverse(some);
    const auto other = trace(some, 28.0);
    ASSERT_EQ(one.has_value(), other.has_value());
    if (!one) continue;
    ASSERT_EQ(one->events.size(), other->events.size()) << i;
    for (std::size_t k = 0; k < one->events.size(); ++k)
      EXPECT_NEAR(one->events[k].phi, other->events[k].phi, 1e-9) << i;
  }
}

}  // namespace
}  // namespace tubecut::joint
