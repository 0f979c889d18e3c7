#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/error.hpp"
#include "core/cutout/hull.hpp"
#include "core/cutout/shadow/square_lines.hpp"

/// The shadow of a prism along a branch's axis on a wall whose lines are square to the outside.
namespace tubecut::cutout {

struct Prism {
  std::vector<HullPart> outline;  // convex, about its axis
  Eigen::Vector3d x, y;           // the outline's axes in space
  Eigen::Vector3d point, axis;    // a unit vector out of the tube
  bool outside_only = false;      // where the prism meets the outside, whatever the wall does below
};

/// The region of the developed outside whose lines the prism meets.
struct Shadow {
  double s = 0.0, z = 0.0;  // of the axis on the outside
  Contour contour;          // about that place, as a cut-out with a developed wall takes it
};

/// Computes the shadow of a prism on the side of the tube by which its axis leaves.
///
/// Errors    open_profile: the axis misses the tube, or the prism reaches the tube's silhouette.
/// Accuracy  within kShadowOff of the developed outside; straight edges and arcs on flats are exact.
/// Source    docs/theory/cutouts.md, section 12.
[[nodiscard]] Result<Shadow> shadow_of(const Prism& prism, const SquareLines& lines);

inline constexpr double kShadowOff = 0.5 * kArcOff;  // mm

}  // namespace tubecut::cutout
