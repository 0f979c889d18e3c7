#pragma once

#include <algorithm>
#include <cmath>

/// The points that were compared, and the largest deviation in mm.
struct Worst {
  long points = 0;
  double deviation = 0.0;
  void see(double value) {
    ++points;
    deviation = std::isnan(value) ? INFINITY : std::max(deviation, value);
  }
};
