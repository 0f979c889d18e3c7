#pragma once

#include <vector>

#include "core/joint/cutters/cutter.hpp"

namespace tubecut::joint {

/// Returns the phases (rad, [0, 2 pi), ascending) at which a cutter's own curve passes from one of
/// its surfaces to another with the same tangent: from a face to a corner of a rectangular tube,
/// from a leg to the bend of an elbow. They are needed because the curvature jumps there, and a
/// part between two of them may be narrower than any step. Some of the phases may have no change.
///
/// Cost      1 us for each pair of surfaces that meet; nothing for the other kinds.
/// Source    docs/theory/intersections-and-bevels.md, section 3.
[[nodiscard]] std::vector<double> borders(const PreparedCutter& cutter, double rho);

}  // namespace tubecut::joint
