#pragma once

#include <cmath>

#include "core/groove/mill_path.hpp"

namespace tubecut::groove {

/// Limits of `verify` that do not depend on size.
inline constexpr double kContactLimit =
    1e-9;  // mm, gaps recomputed by the apex angle; worst seen 1.3e-13
inline constexpr double kCertificateLimit = 1e-9;  // mm, beyond
inline constexpr double kSlopeError = 1e-7;        // of a gap: slopes by differences
inline constexpr double kSagLimit =
    1.2e-3;  // mm; 1e-3 was requested, the check interpolates increments linearly
inline constexpr double kSweptLimit =
    1e-6;  // mm, smallest distances over the motion recomputed by ternary search

/// Returns the rounding of a point's transformation into the machine and back: it grows with all
/// lengths involved.
[[nodiscard]] inline double placing_limit(const MillPathSpec& spec, double sin_a) {
  const double size =
      0.5 * (spec.groove.chord.outer_diameter + spec.groove.branch.outer_diameter) / sin_a;
  return 1e-12 * (size + spec.mill.length + spec.mill.tip_radius + spec.setup.pivot_length +
                  std::abs(spec.setup.z_zero));
}

}  // namespace tubecut::groove
