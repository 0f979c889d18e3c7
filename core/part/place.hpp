#pragma once

#include <optional>

#include "core/base/angle.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::part {

/// A finish's table seen in the start's frame, `length` away: z and phi run the other way, so the
/// rows come in reverse, and every elevation (B, tau, flush) changes its sign.
[[nodiscard]] bevel::Table seen_from_start(const bevel::Table& finish, double length);

/// The least and the greatest z of an end's cut, over both walls.
[[nodiscard]] double lowest(const bevel::Table& table);
[[nodiscard]] double highest(const bevel::Table& table);

/// All z moved by `dz`.
[[nodiscard]] bevel::Table shifted(bevel::Table table, double dz);
[[nodiscard]] bevel::Hole shifted(bevel::Hole hole, double dz);

/// Turn about the part's z from the start's first partner to the finish's, in (-180, 180] deg, each
/// taken on the side towards which it leans: 0 when both long points are on one side, as a brace
/// between two chords that spread apart has them. A partner at right angles leans both ways; then
/// the smaller turn counts, in (-90, 90]. 0 where an end has no side.
[[nodiscard]] double clocking_between(const std::vector<joint::Partner>& start,
                                      const std::vector<joint::Partner>& finish);

}  // namespace tubecut::part
