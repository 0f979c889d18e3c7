#pragma once

#include <cstddef>
#include <vector>

namespace tubecut::bevel {

/// How far each edge of a cut end stands off its partners, one entry a row: to the nearest of them,
/// normal to it, mm. Counted from where the cut must keep off (coating, asked gap, seat); < 0: the
/// edge lies deeper.
struct EdgeGaps {
  std::vector<double> inner, outer;
};

/// The gaps of an end that is cut square to the wall, and at the same places those of the end as a
/// flush bevel would leave it. Empty of any other cut.
struct GapMap {
  EdgeGaps square, bevelled;
};

/// Where the gap is greatest, over both edges and all rows.
struct GreatestGap {
  double gap = 0.0;
  std::size_t row = 0;
  bool outer = false;
};
/// Of gaps that are not empty.
[[nodiscard]] GreatestGap greatest(const EdgeGaps& gaps);

}  // namespace tubecut::bevel
