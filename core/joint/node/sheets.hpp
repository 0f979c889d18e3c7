#pragma once

#include "core/joint/trig_roots.hpp"

namespace tubecut::joint {

/// z = mid +- sqrt(square): both sheets of one part of a cutter around the target. A flat part has
/// square 0.
struct Sheets {
  Trig<1> mid;
  Trig<2> square;
  double size;  // a length to which the rounding of z is proportional
  bool curved;
};

}  // namespace tubecut::joint
