#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "core/joint/node/overlap.hpp"

namespace tubecut::joint {

/// A body that cuts ends and is not cut itself, in the world. `joined`: the members with a joint at
/// it, each with the point of its axis there.
struct Body {
  Partner partner;
  std::vector<std::pair<std::size_t, Eigen::Vector3d>> joined = {};
};

/// The metal of a finished member inside a body. Lengths in mm.
struct BodyOverlap {
  std::size_t member = 0, body = 0;
  double depth = 0.0;  // maximum, below the body's outer surface
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

/// Finds the finished members that enter a body without a joint at it. A body is solid up to its
/// outer surface, because its bore is not known. Tubes, rectangular tubes and cones are endless in
/// requests, so each counts from its first joint to its last one, and two of its sizes beyond them;
/// if it has none, everywhere. An elbow counts at its bend. A plane has no metal. A member whose
/// axis is inside the body from end to end is a liner, or continues the body, and is left out.
///
/// Errors    wrong_count (members: too many overlaps), cancelled.
/// Accuracy  reported if metal is more than 0.01 mm deep, decided by bounds; depth within 0.01 mm
///           and 1 % of it.
/// Cost      0.1 us for a member that is far from a tube, 3 us from another kind; 1 ms for one that
///           enters.
/// Source    docs/theory/intersections-and-bevels.md, section 1.4.
[[nodiscard]] Result<std::vector<BodyOverlap>> overlaps_with(const std::vector<Body>& bodies,
                                                             const NodeSpec& spec,
                                                             const Nodes& nodes,
                                                             const Beside& beside);

}  // namespace tubecut::joint
