#pragma once

#include <set>
#include <utility>
#include <vector>

#include "core/joint/node/node_parts.hpp"

namespace tubecut::joint::detail {

/// Two ends, the lower index first.
using EndPair = std::pair<std::size_t, std::size_t>;

/// Finds the ends that meet at a corner where neither can cut the other, because it would be cut
/// where that one's metal has ended, or both would run into each other: two rails on one round leg,
/// or two pieces of a frame that end where their axes meet. Both are of one outline and their axes
/// meet, so the plane between them closes the corner.
///
/// Only of joints that are found, because a named connection says which member ends on which.
///
/// `ends`: of a solution without these mitres. Members whose joint is stated are left out, and so
/// are ends that are flat on a chord's faces (shared_corner.hpp).
/// Cost  linear in the members, and in the pairs of ends at one chord.
[[nodiscard]] std::set<EndPair> corner_mitres(const Joints& joints,
                                              const std::vector<MemberEnd>& ends);

/// Returns pairs of which the first cuts the second: where the ends of three alike members meet,
/// the two whose axes span the flattest plane in the world cut the third, because posts end on
/// frames. Without this, the order of the list would make each corner of a box another one.
[[nodiscard]] std::set<Applied::Pair> posts_on_corners(const NodeSpec& spec, const Joined& joined,
                                                       const Lines& lines);

}  // namespace tubecut::joint::detail
