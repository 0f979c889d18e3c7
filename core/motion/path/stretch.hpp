#pragma once

#include <vector>

#include "core/motion/path/cut_path.hpp"

namespace tubecut::motion {

/// Returns the point at the fraction 0 to 1 from one to the other at which both edges are on their
/// straight lines; no corner. `wall`: of the track.
[[nodiscard]] CutPoint between(const WallRadii& wall, const CutPoint& a, const CutPoint& b,
                               double share);

/// Returns the first `length` mm of a track, including its start point. Here and below, a place
/// within 1e-8 mm of a point counts as that point, so no point occurs twice.
[[nodiscard]] std::vector<CutPoint> first_stretch(const Track& track, double length);

/// Returns the tip path up to each point, mm.
[[nodiscard]] std::vector<double> lengths_along(const Track& track);

/// Returns the place at a length along a track whose points' lengths are given; if there are
/// several, the last.
[[nodiscard]] CutPoint at_length(const Track& whole, const std::vector<double>& length, double at);

/// Returns the open part of a closed track between two of its lengths; both ends are points of it.
[[nodiscard]] Track stretch_of(const Track& whole, const std::vector<double>& length, double from,
                               double to);

}  // namespace tubecut::motion
