#pragma once

#include <vector>

#include "core/bevel/smoothing/smoothing.hpp"

namespace tubecut::bevel {

/// Computes f >= B by construction only: from every node a curve that brakes at the rate A down to
/// the slope K, in both directions, and a parabola rolled over the highest of them. Always
/// feasible; |slope| <= K, |second difference| <= A, f <= highest. rad. Not the minimum: 1.2 times
/// its area at the published node.
///
/// Cost    linear.
/// Source  docs/theory/intersections-and-bevels.md, section 6.2.
[[nodiscard]] std::vector<double> braking_envelope(const AngleProfile& profile,
                                                   const EnvelopeSpec& spec);

}  // namespace tubecut::bevel
