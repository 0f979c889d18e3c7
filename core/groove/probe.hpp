#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/groove/mill_path.hpp"

namespace tubecut::groove {

/// A point of the groove's surface, and the position `omega` of the mill.
struct ProbePoint {
  Angle omega;     // of the tool
  Angle ruling;    // of the point
  double v = 0.0;  // from curve 3 to curve 4
};

/// Its distance (14) to the unbounded flank of the mill, < 0 if it is cut away.
struct Probed {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // mm, in the branch's frame
  double before = 0.0,
         after = 0.0;  // mm; from the initial position of that section, and from the path
  AxisPosition at_before = {}, at = {};  // the positions of the two
};

/// The points along a path where the flank cuts deepest into the surface, and where it leaves most
/// (15).
struct Deepest {
  ProbePoint at;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance = 0.0;  // mm
};
struct DeepestPlaces {
  Deepest over, under;  // P_max, W_max
};

struct Probe {
  std::vector<Probed> points;
  DeepestPlaces before, after;  // of the contact lines of all positions
};

/// Computes the probes. Between two positions of the path the machine's axes run linearly.
///
/// Errors    those of `section` (member "probe/i"); cancelled.
/// Accuracy  distances 1e-10 mm.
/// Cost      about 2 us a point.
/// Source    docs/theory/grooves-and-milling.md, section 7.
[[nodiscard]] Result<Probe> probe(const MillPathSpec& spec, const MillPath& path,
                                  const std::vector<ProbePoint>& asked);

/// Recomputes the distances in the branch's frame, from the cone's apex angle.
[[nodiscard]] Check verify(const MillPathSpec& spec, const std::vector<ProbePoint>& asked,
                           const Probe& probe);

}  // namespace tubecut::groove
