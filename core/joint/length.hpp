#pragma once

#include <span>
#include <vector>

#include "core/joint/contour.hpp"

namespace tubecut::joint {

/// Computes the true length of the contour between two phases of one segment (rad, from <= to, both
/// within it).
/// Accuracy  1e-9 mm on the published cases; 1e-9 of the length (worst seen 2e-12), also where the
///           curve turns vertical at a silhouette.
[[nodiscard]] double arc_length(const Contour& contour, const Segment& segment, double from,
                                double to);

/// Computes the true length from phi = 0 to each of the ascending phases (rad, [0, 2 pi)); at a
/// jump the height difference counts after the first of two equal phases. The result has one more
/// entry than phases: the last is the length of the whole closed curve.
/// Accuracy  as arc_length, however narrow a cutter's corners are; the total does not depend on the
///           phases beyond that.
/// Cost      seven slopes for each smooth gap, vectorised. If cancelled, the rest are 0.
/// Source    docs/theory/intersections-and-bevels.md, section 3.
[[nodiscard]] std::vector<double> lengths_along(const Contour& contour,
                                                std::span<const double> phases);

/// Computes the true length of the whole contour, mm; its developed length is 2 pi radius.
[[nodiscard]] double true_length(const Contour& contour);

}  // namespace tubecut::joint
