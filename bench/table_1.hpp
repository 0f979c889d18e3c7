#pragma once

#include <vector>

#include "core/bevel/table/table.hpp"

namespace tubecut {

/// Source 000, Table 1.
inline constexpr double kTable1[][4] = {
    {55, 85, 0, 0}, {35, 65, 90, 15}, {35, 35, 245, -5}, {35, 55, 320, 0}};

inline std::vector<joint::Partner> table_1() {
  std::vector<joint::Partner> out;
  for (const auto& n : kTable1)
    out.emplace_back(joint::TubeCutter{.radius = n[0],
                                       .inclination = Angle::deg(n[1]),
                                       .clocking = Angle::deg(n[2]),
                                       .offset = n[3]});
  return out;
}

inline bevel::TableSpec table_1_spec(bool refine) {
  const bevel::BevelRateLimits limits{.slope = 5.0 * kRadPerDeg, .curvature = 1.0 * kRadPerDeg};
  return {.target = {.outer_radius = 35, .wall = 5},
          .partners = table_1(),
          .sampling = {.uniform_points = 360},
          .groove = bevel::HalfDihedral{},
          .smoothing = bevel::EnvelopeSmoothing{.limits = limits, .refine = refine}};
}

}  // namespace tubecut
