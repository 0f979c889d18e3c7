#pragma once

namespace tubecut::math {

/// At the share u of the way from a to b; exactly a at 0, exactly b at 1.
[[nodiscard]] inline double mixed(double a, double b, double u) { return (1.0 - u) * a + u * b; }

}  // namespace tubecut::math
