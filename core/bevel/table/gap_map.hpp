#pragma once

#include <cstddef>
#include <vector>

namespace tubecut::bevel {

/// The distance of each edge of a cut end to its nearest partner, one entry per row, normal to the
/// partner, mm. Measured from the required distance (coating, requested gap, seat); < 0: the edge
/// lies deeper.
struct EdgeGaps {
  std::vector<double> inner, outer;
};

/// The gaps of an end that is cut square to the wall, and at the same rows those of a flush bevel
/// of the same end. Empty for any other cut.
struct GapMap {
  EdgeGaps square, bevelled;
};

/// The position of the largest gap, over both edges and all rows.
struct GreatestGap {
  double gap = 0.0;
  std::size_t row = 0;
  bool outer = false;
};
/// The gaps must not be empty.
[[nodiscard]] GreatestGap greatest(const EdgeGaps& gaps);

}  // namespace tubecut::bevel
