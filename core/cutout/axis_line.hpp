#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/cutout/chain.hpp"

/// The torch's axis along a cut-out, where it turns in hollows.
namespace tubecut::cutout {

/// One place of the edge and the torch's axis for it, in the plane of the offset.
struct AxisRow {
  Flat edge, torch;
};

/// Where the tail of one line first crosses the head of another, by the index of the last place
/// kept of the one and the first of the other.
struct LineCrossing {
  std::size_t last, first;
  Flat at;
};
[[nodiscard]] std::optional<LineCrossing> crossing(const std::vector<AxisRow>& one,
                                                   const std::vector<AxisRow>& other);

/// Where the axis crosses itself within two kerfs of its way, in a hollow that spans several short
/// segments, it turns at the crossing instead.
void turn_in_hollows(double kerf, std::vector<AxisRow>& rows);

/// Checks that the torch's line does not cross itself.
/// Errors  out_of_range (where it does, the contour is narrower than the kerf), cancelled.
[[nodiscard]] Result<void> check_line(const std::vector<AxisRow>& rows);

}  // namespace tubecut::cutout
