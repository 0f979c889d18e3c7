#pragma once

#include <optional>

namespace tubecut::motion {

/// The two surfaces of a wall, mm.
struct WallRadii {
  double outer = 0.0;
  double inner = 0.0;
};

/// The torch's axis at a wall: it meets the outer surface at (phi, z) and runs outwards along (1,
/// tan a around the tube, tan b along it). mm, rad.
struct TorchLean {
  double phi = 0.0, z = 0.0, b = 0.0, a = 0.0;
};

/// The point where the axis leaves the inner surface.
struct InnerExit {
  double phi = 0.0, z = 0.0;
};

/// Computes where the torch's axis leaves the inner surface; empty when it misses it.
///
/// Source  With C = ro^2 - ri^2 and rho = tan a, depth h solves (1 + rho^2) h^2 - 2 ro h + C = 0.
[[nodiscard]] std::optional<InnerExit> inner_exit(const WallRadii& wall, const TorchLean& at);

/// Interpolates the torch at `share` (0 to 1) from one place to another, such that both edges lie
/// on their straight lines in (phi, z), each on its own surface. Without a tilt across (a = 0), tan
/// b is linear, for any wall. Works for either sign of b.
///
/// If the axis grazes the inner surface at either place, tan a and tan b are linear.
///
/// Example  between({50, 45}, {0, 0, 0}, {0.1, 2, 0.5}, 0.5).b is atan(tan(0.5) / 2).
/// Accuracy  rounding.
[[nodiscard]] TorchLean between(const WallRadii& wall, const TorchLean& from, const TorchLean& to,
                                double share);

}  // namespace tubecut::motion
