#pragma once

#include <optional>
#include <stop_token>

#include "core/base/error.hpp"
#include "core/groove/joint.hpp"

namespace tubecut::groove {

/// Area of the filler in the plane through P1 normal to curve 3 at omega, mm^2: of the groove as it
/// is cut, so that the plane meets neighbouring sections higher up. Empty where the plane runs more
/// than 80 deg around the branch before it meets an edge of the filler.
///
/// Accuracy  1e-5 of itself.
/// Cost      about 0.2 ms.
[[nodiscard]] std::optional<double> normal_area(const Joint& joint, Angle omega);

/// The axial area that one section is to have.
struct KeptArea {
  Angle at;
  double axial = 0.0;  // mm^2
};

/// Makes the joint's normal sections equal: finds the factor of its axial areas, from 1 / cos psi
/// on. With `kept` that section has the axial area named there, and the joint's area is the one of
/// its normal section; else it is the asked one.
///
/// Errors    normal_area, where they cannot be made equal within `kNormalAreaLimit`: where the seam
///           is steep and the groove high the planes cross one another.
/// Cost      about 10 ms a round, three to eight of them.
/// Source    docs/theory/grooves-and-milling.md, section 1.
[[nodiscard]] Result<void> equal_normal_areas(Joint& joint, const std::optional<KeptArea>& kept,
                                              const std::stop_token& stop = {});

inline constexpr double kNormalAreaLimit = 1e-3;  // of the area

/// The largest share by which a normal section's area is off `area`, at so many stations.
[[nodiscard]] double normal_area_off(const Joint& joint, double area, int stations,
                                     const std::stop_token& stop = {});

}  // namespace tubecut::groove
