#pragma once

#include "core/joint/trig_roots.hpp"

namespace tubecut::joint {

/// z = mid +- sqrt(square): both sheets of one piece of a cutter around the target. A flat piece
/// has square 0.
struct Sheets {
  Trig<1> mid;
  Trig<2> square;
  double size;  // a length the rounding of z is proportional to
  bool curved;
};

}  // namespace tubecut::joint
