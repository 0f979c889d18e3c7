#pragma once

#include <vector>

#include "core/joint/cutters/cutter.hpp"

namespace tubecut::joint {

/// Phases (rad, [0, 2 pi), ascending) at which a cutter's own curve passes from one of its surfaces
/// to another with the same tangent: from a face to a corner of a rectangular tube, from a leg to
/// the bend of an elbow. Its curvature jumps there, and what lies between two of them may be
/// narrower than any step. Phases at which nothing changes may be among them.
///
/// Cost      1 us for each pair of surfaces that meet; nothing for the other kinds.
/// Source    docs/theory/intersections-and-bevels.md, section 3.
[[nodiscard]] std::vector<double> borders(const PreparedCutter& cutter, double rho);

}  // namespace tubecut::joint
