#pragma once

namespace tubecut::math {

/// Interpolates linearly at the fraction u from a to b; exactly a at 0 and b at 1 for finite a and
/// b.
[[nodiscard]] inline double mixed(double a, double b, double u) { return (1.0 - u) * a + u * b; }

}  // namespace tubecut::math
