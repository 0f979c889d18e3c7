#pragma once

#include <cstddef>
#include <optional>

#include "core/motion/path/cut_path.hpp"

namespace tubecut::motion {

/// Returns the point with the smallest tilt among those well away from corners; if there are none,
/// the point farthest from corners. Of an opening's points with equal tilt, the one in the middle
/// of its longest straight side, because a lead fits there.
[[nodiscard]] std::size_t automatic_start(const Track& t, const std::optional<Angle>& seam);

}  // namespace tubecut::motion
