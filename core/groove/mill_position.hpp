#pragma once

#include <array>
#include <vector>

#include "core/base/angle.hpp"
#include "core/groove/mill.hpp"
#include "core/groove/overcut.hpp"

namespace tubecut::groove {

/// Gap and offset of the touched ruling, by v from curve 3 to curve 4.
struct ContactLine {
  std::vector<double> gap;                        // mm, < 0 overcut
  std::vector<double> offset;                     // rad
  double over = 0.0, under = 0.0, largest = 0.0;  // mm
};

/// One emitted position.
struct MillPosition {
  Angle omega;
  AxisPosition at;         // B continuous with the position before
  Increment by;            // from the initial position
  bool optimised = false;  // false: between two optima, with their interpolated increments
  ContactLine before, after;
  GridFigures grid_before, grid;  // the source's own
  double certificate = 0.0;       // mm
  double bias = 0.0;              // mm, the reference of the certificate
  std::array<int, 3> reference = {};
  int evaluations = 0;  // 0 between optima
  bool qualified = false;
};

}  // namespace tubecut::groove
