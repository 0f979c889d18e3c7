#pragma once

#include <functional>
#include <optional>

#include "core/base/error.hpp"
#include "core/bevel/hole/hole.hpp"

namespace tubecut::bevel {

/// A lean above this may be the reason why a beam is too wide for a wall, rad.
inline constexpr double kSteepLean = 55.0 * kRadPerDeg;

/// Returns the error for a torch that cannot keep the wall off the branch at these phases of it,
/// deg, and needs a lean of `needs` rad. It names the torch's range if a wider one helps, else the
/// tilt, or the branch.
[[nodiscard]] Issue beyond_torch(const HoleSpec& spec, Intervals phases, double needs);

/// Returns the furthest that the torch leans from the surface's normal, rad.
[[nodiscard]] double furthest_lean(const Hole& hole);

/// Finds why a beam as wide as the kerf does not fit a hole whose torch leans by up to `lean`: such
/// a torch cuts edges that are many wall thicknesses from each other. In the order of causes: the
/// groove that requests the lean, the range that permits it, the tilt. Each comes with a value that
/// `can_be_cut`; empty when no cause helps, so that the kerf itself is the cause.
///
/// Cost  at most eight calls of `can_be_cut`.
[[nodiscard]] std::optional<Issue> first_cause(
    const HoleSpec& spec, double lean, const std::function<bool(const HoleSpec&)>& can_be_cut);

}  // namespace tubecut::bevel
