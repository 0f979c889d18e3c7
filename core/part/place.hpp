#pragma once

#include <optional>

#include "core/base/angle.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::part {

/// Transforms a finish's table into the start's frame, `length` away: z and phi change direction,
/// so the rows come in reverse, and every elevation (B, tau, flush) changes its sign.
[[nodiscard]] bevel::Table seen_from_start(const bevel::Table& finish, double length);

/// Moves all z by `dz`.
[[nodiscard]] bevel::Table shifted(bevel::Table table, double dz);
[[nodiscard]] bevel::Hole shifted(bevel::Hole hole, double dz);

/// Computes the rotation about the part's z from the start's first partner to the finish's, in
/// (-180, 180] deg. Each is taken on the side to which it leans: 0 if both long points are on one
/// side, as on a brace between two diverging chords. A partner at right angles leans both ways, so
/// the smaller rotation counts, in (-90, 90]. 0 if an end has no side.
[[nodiscard]] double clocking_between(const std::vector<joint::Partner>& start,
                                      const std::vector<joint::Partner>& finish);

}  // namespace tubecut::part
