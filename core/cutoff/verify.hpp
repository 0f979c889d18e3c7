#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/cutoff/feed_curve.hpp"

namespace tubecut::cutoff {

/// The limits of `verify`. Ratios are plain numbers; each is far above rounding and far below the
/// accuracy of a machine.
namespace limit {
inline constexpr double kFeed =
    1e-9;  // of |x| + A/cos^2 psi: the feed from a stroke by eq. (4) against the given feed
inline constexpr double kSpeed = 1e-8;         // of the speed: against v/f'
inline constexpr double kAcceleration = 1e-7;  // of the terms of -v^2 f''/f'^3
inline constexpr double kStrokeLimit =
    1e-9;  // of |O2 P|: a length that is zero at the ends of the stroke's range
inline constexpr double kExtreme =
    1e-3;  // of the largest speed or acceleration: as measured on 2000 equal steps
inline constexpr double kPace = 1e-12;     // of the feed: x = x_s + v t
inline constexpr double kForms = 1e-9;     // of the speed: the coefficient forms against each other
inline constexpr double kFitError = 2e-3;  // of the stated errors: as measured on 2000 equal steps
inline constexpr double kMinimax = 1e-6;   // of the other methods' error: minimax is never above
inline constexpr double kCycleLimit = 1e-9;  // of the speed and acceleration limits
inline constexpr double kCycleStep =
    1.0 + 1e-6;  // of the change that the jerk limit can hide in a sample interval
inline constexpr double kCycleTime = 1e-12;  // of the cycle: its times and the piece rate
inline constexpr double kRest = 0.0;         // mm, mm/s, mm/s^2: the last sample is exactly at rest
inline constexpr double kTool = 1e-12;       // of each figure of feed and roughness
inline constexpr double kWallCut =
    1e-9;  // of each figure of the wall: thin walls cancel in the verification
}  // namespace limit

/// Verifies an answer of `feed_curve` by formulas independent of those that computed it: eq. (4) as
/// a quotient of lengths for every stroke, its derivatives in coordinates for speeds and
/// accelerations, Newton on eq. (4) and Horner in seconds for the polynomial, differences between
/// samples for the cycle. Every check is a ratio, its limit in `limit`.
///
/// Cost      about that of the answer.
/// Source    docs/theory/feed-curves.md, sections 2 to 6.
[[nodiscard]] std::vector<Check> verify(const FeedCurveSpec& spec, const FeedCurve& curve);

}  // namespace tubecut::cutoff
