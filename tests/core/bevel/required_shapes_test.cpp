#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "core/bevel/table/required.hpp"
#include "core/joint/contour.hpp"
#include "core/joint/solid.hpp"

// Required bevel and support height for boxes and cones against a dense scan of the wall by the
// partners' solids, whose formulas are others.

namespace tubecut::bevel {
namespace {

constexpr std::uint64_t kSeed = 20260122;
constexpr int kNodes = 30, kPhases = 16, kScan = 401;

std::vector<joint::Cutter> random_partners(std::mt19937_64& random, double rho) {
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto axis = [&] {
    const double phi = any(0, kTwoPi);
    return Eigen::Vector3d(std::cos(phi), std::sin(phi), any(-0.7, 0.7));
  };
  const double width = rho * any(2.6, 4.0), height = rho * any(2.6, 4.0);
  std::vector<joint::Cutter> out;
  out.emplace_back(joint::RectangularTubeCutter{.width = width,
                                                .height = height,
                                                .corner = any(0.05, 0.5) * std::min(width, height),
                                                .point = {any(-5, 5), any(-5, 5), any(-20, 20)},
                                                .direction = axis(),
                                                .up = {0.2, 0.1, 1.0}});
  out.emplace_back(joint::ConeCutter{.radius = rho * any(0.4, 1.6),
                                     .half_angle = Angle::deg(any(-30, 30)),
                                     .point = {any(-30, 30), any(-30, 30), any(0, 60)},
                                     .direction = axis()});
  out.emplace_back(joint::RectangularTubeCutter{.width = rho * any(0.5, 2),
                                                .height = rho * any(0.5, 2),
                                                .corner = 0.05 * rho,
                                                .point = {any(-40, 40), any(-40, 40), any(0, 80)},
                                                .direction = axis(),
                                                .up = {0.2, 1.0, 0.7}});
  return out;
}

TEST(RequiredShapes, NeverBelowTheScanAndNoMoreThanItNeeds) {
  std::mt19937_64 random(kSeed);
  double worst_below = 0.0, worst_above = 0.0, worst_lift = 0.0;
  int compared = 0, other = 0;
  for (int n = 0; n < kNodes; ++n) {
    const double inner = std::uniform_real_distribution<double>(20, 60)(random);
    const Wall wall{inner, inner * std::uniform_real_distribution<double>(1.05, 1.3)(random)};
    const auto cutters = random_partners(random, wall.outer);
    const auto contour = joint::trace(cutters, wall.inner);
    if (!contour) continue;
    std::vector<joint::Solid> solids;
    for (const auto& c : cutters) solids.emplace_back(c);
    for (int k = 0; k < kPhases; ++k) {
      const double phi = kTwoPi * (k + 0.5) / kPhases;
      const auto line = joint::generator_at(wall.inner, phi);
      const auto contact = joint::contact_at(*contour, phi);
      double steepest = -1e300, highest = -1e300;
      const double m = std::uniform_real_distribution<double>(-1.5, 1.5)(random);
      for (int j = 0; j < kScan; ++j) {
        // Denser towards the root, where a steep start shows.
        const double share = static_cast<double>(j) / (kScan - 1);
        const double rho = wall.inner + (wall.outer - wall.inner) * share * share;
        for (const auto& solid : solids) {
          const auto z = solid.top(rho * line.cos_phi, rho * line.sin_phi);
          if (!z) continue;
          if (j > 0) steepest = std::max(steepest, (*z - contact.z) / (rho - wall.inner));
          highest = std::max(highest, *z - (rho - wall.inner) * m);
        }
      }
      const double b = required_bevel(contour->cutters, wall, line, contact.z);
      const double scanned = std::atan(steepest);
      worst_below = std::max(worst_below, scanned - b);
      // If a cutter is met only next to the wall's inner edge, it may need more than the scan's
      // first step sees.
      worst_above = std::max(worst_above, b - scanned);
      worst_lift = std::max(worst_lift, std::abs(lift(contour->cutters, wall, line, m) - highest));
      ++compared;
      if (contact.cutter != 0) ++other;
    }
  }
  std::cout << compared << " compared, " << other << " not on the first; B below the scan by "
            << worst_below << ", above by " << worst_above << " rad, lift off by " << worst_lift
            << " mm\n";
  EXPECT_GT(compared, kNodes * kPhases / 2);
  EXPECT_GT(other, 20);
  EXPECT_LT(worst_below, 1e-7);
  EXPECT_LT(worst_above, 1e-4);
  EXPECT_LT(worst_lift, 1e-3);
}

}  // namespace
}  // namespace tubecut::bevel
