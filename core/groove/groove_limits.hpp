#pragma once

#include "core/groove/joint_geometry.hpp"

namespace tubecut::groove {

/// Limits of `verify` that do not depend on size. They limit derivatives by differences, and
/// figures of a revolution between its stations.
inline constexpr double kTwistLimitDeg = 1e-4;   // central differences; worst seen 8e-7
inline constexpr double kHeightLimit = 1e-9;     // of the same stations
inline constexpr double kLeastAreaLimit = 1e-9;  // likewise, by quadrature; of the filler area
inline constexpr double kVolumeLimit =
    2e-5;  // two trapezoids at half a step's distance; 6e-6 at a kink of curve 3
inline constexpr double kLengthLimit = 1e-4;  // a polygon of 720 sides against a smooth integral

/// Limits of rounding: they grow with the joint.
struct GrooveLimits {
  double on_chord = 0.0;    // mm
  double weld_width = 0.0;  // mm
  double area = 0.0;        // mm^2
  double curves = 0.0;      // mm
};

/// z reaches (R + r) / sin(alpha); 1e-13 of it is about 450 roundings; worst seen 0.5 % of it.
[[nodiscard]] constexpr GrooveLimits groove_limits(const JointGeometry& joint) {
  const double size = joint.chord_radius + joint.branch_radius;
  const double reach = size / joint.sin_a;
  return {.on_chord = 1e-13 * reach,
          .weld_width = 1e-13 * reach,
          .area = 1e-10 * joint.area + 1e-13 * reach * joint.weld_width,
          .curves = 1e-13 * reach};
}

}  // namespace tubecut::groove
