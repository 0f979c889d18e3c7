#pragma once

#include <vector>

#include "core/joint/cutter.hpp"
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

/// The pieces whose highest sheet is the cutter's own: a tube, plane or cone is one; a box has its
/// faces and the cylinders of its corners, each continued without end. An elbow has none: its
/// surface is of the fourth degree, and its events are bracketed instead.
[[nodiscard]] std::vector<Sheets> sheets(const Prepared& cutter, double rho);

/// Phases at which a generator touches a box, cone or elbow from outside, and perhaps others. An
/// elbow's are bracketed on a scan: one that is met over less than half a degree may be missed
/// unless the scan sees the generator come near.
[[nodiscard]] std::vector<double> silhouettes(const Prepared& cutter, double rho);

}  // namespace tubecut::joint
