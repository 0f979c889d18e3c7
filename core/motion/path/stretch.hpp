#pragma once

#include <vector>

#include "core/motion/path/cut_path.hpp"

namespace tubecut::motion {

/// The point so far along the way from one to the other, 0 to 1, at which both edges are on their
/// straight lines; no corner. `wall`: of the track.
[[nodiscard]] CutPoint between(const WallRadii& wall, const CutPoint& a, const CutPoint& b,
                               double share);

/// The first `length` mm of a track, its start point included. Here and below, a place within 1e-8
/// mm of a point is that point: none stands twice.
[[nodiscard]] std::vector<CutPoint> first_stretch(const Track& track, double length);

/// Tip path up to each point, mm.
[[nodiscard]] std::vector<double> lengths_along(const Track& track);

/// The place at a length along a track whose points' lengths are given; of several the last.
[[nodiscard]] CutPoint at_length(const Track& whole, const std::vector<double>& length, double at);

/// The open stretch of a closed track between two of its lengths, both ends points of it.
[[nodiscard]] Track stretch_of(const Track& whole, const std::vector<double>& length, double from,
                               double to);

}  // namespace tubecut::motion
