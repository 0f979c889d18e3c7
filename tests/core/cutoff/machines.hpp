#pragma once

#include "core/cutoff/feed_curve.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::cutoff::testing {

/// A machine of the golden file ({R1, R2, A, theta0, alpha, k} in mm and rad).
inline Linkage linkage_of(const api::Json& params) {
  using tubecut::testing::number;
  return {.arm = number(params, "R1"),
          .pivot_distance = number(params, "R2"),
          .pivot_offset = number(params, "A"),
          .rest_angle = Angle::rad(number(params, "theta0")),
          .slot_angle = Angle::rad(number(params, "alpha")),
          .rad_per_mm = number(params, "k")};
}

/// The source's Table 1, with the k that its equation (9) implies.
inline Linkage table_1() {
  return {.arm = 323.0,
          .pivot_distance = 268.0,
          .pivot_offset = 56.0,
          .rest_angle = Angle::rad(1.17),
          .slot_angle = Angle::rad(1.82),
          .rad_per_mm = 0.00044038};
}

/// The source's Table 3, with k = 0.000 486 for the printed 0.004 86.
inline Linkage table_3() {
  return {.arm = 430.0,
          .pivot_distance = 340.0,
          .pivot_offset = 90.0,
          .rest_angle = Angle::rad(1.3),
          .slot_angle = Angle::rad(1.69),
          .rad_per_mm = 0.000486};
}

inline CycleSpec cycle_limits() {
  return {.period = 0.002,
          .max_cylinder_speed = 150.0,
          .max_cylinder_acceleration = 800.0,
          .max_cylinder_jerk = 20000.0,
          .max_feed = 39.0,
          .dwell = 0.0,
          .handling = 10.0,
          .target = 120.0};
}

/// The golden file's cycle case on Table 3 with all options.
inline FeedCurveSpec table_3_request() {
  return {.linkage = table_3(),
          .cut = {CutDistances{12.0, 2.0, 10.0, 3.0}, 1.0},
          .fit = {},
          .table = {},
          .cycle = cycle_limits(),
          .tool = ToolSpec{300.0, 3, 0.4, 4.0},
          .tube = TubeSpec{194.0, 10.0},
          .comparison = ComparisonSpec{}};
}

}  // namespace tubecut::cutoff::testing
