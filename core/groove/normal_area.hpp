#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "core/groove/joint_geometry.hpp"

namespace tubecut::groove {

/// Computes the area of the filler in the plane through P1 normal to curve 3 at omega, mm^2: of the
/// groove as cut, so that the plane meets neighbouring sections higher up. Returns empty when the
/// plane runs more than 80 deg around the branch before it meets an edge of the filler.
///
/// Accuracy  1e-5 of itself.
/// Cost      about 0.2 ms.
[[nodiscard]] std::optional<double> normal_area(const JointGeometry& joint, Angle omega);

/// The required axial area of one section.
struct KeptArea {
  Angle at;
  double axial = 0.0;  // mm^2
};

/// Makes the joint's normal sections equal: finds the factor of its axial areas, starting at 1 /
/// cos psi. If `kept` is set, its section gets the given axial area, and the joint's area is that
/// of its normal section; else it is the requested one.
///
/// Errors    normal_area, if they cannot be made equal within `kNormalAreaLimit`: where the seam is
///           steep and the groove high, the planes cross one another.
/// Cost      about 10 ms a round, three to eight of them.
/// Source    docs/theory/grooves-and-milling.md, section 1.
[[nodiscard]] Result<void> equal_normal_areas(JointGeometry& joint,
                                              const std::optional<KeptArea>& kept);

inline constexpr double kNormalAreaLimit = 1e-3;  // of the area

/// Returns the largest relative error of a normal section's area against `area`, over this many
/// stations.
[[nodiscard]] double normal_area_off(const JointGeometry& joint, double area, int stations);

}  // namespace tubecut::groove
