#pragma once

#include <functional>
#include <optional>

#include "core/base/error.hpp"
#include "core/bevel/hole/hole.hpp"

namespace tubecut::bevel {

/// A lean from here on may be why a beam is too wide for a wall, rad.
inline constexpr double kSteepLean = 55.0 * kRadPerDeg;

/// The error of a torch that cannot keep the wall off the branch at these phases of it, deg, and
/// would have to lean `needs` rad for it: at its range as long as a wider one helps, else at the
/// tilt, or at the branch.
[[nodiscard]] Issue beyond_torch(const HoleSpec& spec, Intervals phases, double needs);

/// Returns the furthest that the torch leans from the surface's normal, rad.
[[nodiscard]] double furthest_lean(const Hole& hole);

/// Finds why a beam as wide as the kerf does not fit a hole whose torch leans as far as `lean`: a
/// torch that leans so far cuts edges that are many times the wall apart. In the order of causes:
/// the groove that requests the lean, the range that allows it, the tilt. Each comes with a value
/// that `can_be_cut`; nothing if none of them helps, so that the kerf itself is the cause.
///
/// Cost  at most eight calls of `can_be_cut`.
[[nodiscard]] std::optional<Issue> first_cause(
    const HoleSpec& spec, double lean, const std::function<bool(const HoleSpec&)>& can_be_cut);

}  // namespace tubecut::bevel
