#pragma once

#include "core/bevel/smoothing/smoothing.hpp"

namespace tubecut::bevel {

/// No profile that keeps the limits of `spec` above `profile` has a smaller area (rad mm) than
/// this, by weak duality: from the multipliers alone, whatever solver they come from. Contacts are
/// scaled to hold the whole weight; the multipliers of the second difference follow from the others
/// by summing twice round the ring.
///
/// Multipliers of another number of nodes, or that are no numbers, prove nothing: -infinity.
/// `area` is that of some profile that does: a height above B is worth no more than it.
/// Accuracy  1e-13 of the period times the range of B.
/// Cost      linear.
/// Source    docs/theory/intersections-and-bevels.md, section 6.3.
[[nodiscard]] double least_area(const AngleProfile& profile, const EnvelopeSpec& spec,
                                const Multipliers& multipliers, double area);

/// Multipliers that prove no more than that no area is below zero.
[[nodiscard]] Multipliers no_multipliers(const AngleProfile& profile);

/// By what share `area` exceeds the least: of it, or of a millionth of a radian all round where it
/// is smaller than that.
[[nodiscard]] double area_excess(const AngleProfile& profile, double least, double area);
[[nodiscard]] double area_excess(const AngleProfile& profile, const EnvelopeSpec& spec,
                                 const Multipliers& multipliers, double area);

}  // namespace tubecut::bevel
