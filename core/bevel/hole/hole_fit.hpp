#pragma once

#include "core/bevel/hole/hole.hpp"

namespace tubecut::bevel {

/// Returns the chord as the partner of the branch's end: its clocking is 0 by the choice of the
/// branch's phase.
[[nodiscard]] joint::TubeCutter chord_seen_from(const joint::TubeCutter& branch, double radius);

/// For each gap between nodes, returns true if the wall that faces the other member is nearer to it
/// than requested by more than the tolerance: the hole's wall to the branch, the branch's end to
/// the chord.
///
/// Accuracy  none is missed; flagged from 0.98 of the tolerance on (`entering`).
[[nodiscard]] std::vector<bool> too_near_between(const HoleSpec& spec,
                                                 const joint::TubeCutter& branch, const Hole& hole);
[[nodiscard]] std::vector<bool> too_near_between(const HoleSpec& spec,
                                                 const joint::TubeCutter& branch,
                                                 const BranchEnd& end);

/// Measures the gap between the two cut surfaces in 3D from the tables themselves: set-on, the
/// branch's end to the chord's outer surface; else the hole's wall to the branch's outer surface.
[[nodiscard]] FitUp fit_up(const HoleSpec& spec, const joint::TubeCutter& branch,
                           const HoleCut& cut, const Hole& hole);

/// Adds a warning if a bare grid is nearer than the requested gap by more than joint::Tolerance's.
void note_nearest(const HoleSpec& spec, HoleCut& cut);

/// Checks the stated nearest points of the fit-ups, at those points and at others, by the distance
/// to an axis.
[[nodiscard]] std::vector<Check> nearest_checks(const HoleSpec& spec,
                                                const joint::TubeCutter& branch,
                                                const HoleCut& cut);

}  // namespace tubecut::bevel
