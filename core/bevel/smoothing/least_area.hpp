#pragma once

#include "core/bevel/smoothing/smoothing.hpp"

namespace tubecut::bevel {

/// Returns a lower bound of the area (rad mm) of every profile that keeps the limits of `spec`
/// above `profile`, by weak duality: from the multipliers only, whichever solver computed them.
/// Contacts are scaled to the whole weight; the multipliers of the second difference follow from
/// the others by summing twice around the ring.
///
/// If the number of multipliers is wrong or one is not finite, returns -infinity. `area` is that of
/// some valid profile: no height above B contributes more than it.
/// Accuracy  1e-13 of the period times the range of B.
/// Cost      linear.
/// Source    docs/theory/intersections-and-bevels.md, section 6.3.
[[nodiscard]] double least_area(const AngleProfile& profile, const EnvelopeSpec& spec,
                                const Multipliers& multipliers, double area);

/// Returns multipliers that only prove that no area is below zero.
[[nodiscard]] Multipliers no_multipliers(const AngleProfile& profile);

/// Returns the fraction by which `area` exceeds the minimum: of it, or of a millionth of a radian
/// on the whole path if that is larger.
[[nodiscard]] double area_excess(const AngleProfile& profile, double least, double area);
[[nodiscard]] double area_excess(const AngleProfile& profile, const EnvelopeSpec& spec,
                                 const Multipliers& multipliers, double area);

}  // namespace tubecut::bevel
