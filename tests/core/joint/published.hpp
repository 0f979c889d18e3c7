#pragma once

#include <vector>

#include "core/joint/cutters/cutter.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::joint {

inline constexpr const char* kGolden = "intersections-and-bevels.json";

inline TubeCutter tube_deg(double radius, double inclination, double clocking, double offset,
                           double height = 0.0) {
  return {radius, Angle::deg(inclination), Angle::deg(clocking), offset, height};
}

/// Source 000, Table 1.
inline std::vector<Cutter> table1() {
  return {tube_deg(55, 85, 0, 0), tube_deg(35, 65, 90, 15), tube_deg(35, 35, 245, -5),
          tube_deg(35, 55, 320, 0)};
}

inline std::vector<Cutter> eccentric_cutters(const api::Json& golden) {
  std::vector<Cutter> out;
  for (int i = 0; i < 4; ++i) {
    const auto row =
        testing::numbers(golden, "eccentric/cutters_r_alpha_beta_s_h/" + std::to_string(i));
    out.emplace_back(tube_deg(row.at(0), row.at(1), row.at(2), row.at(3), row.at(4)));
  }
  return out;
}

}  // namespace tubecut::joint
