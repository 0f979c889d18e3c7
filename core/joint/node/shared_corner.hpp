#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/joint/node/node_parts.hpp"

namespace tubecut::joint::detail {

/// One end of a member.
struct EndOf {
  const Member& member;
  End end;
};

/// Returns true if two ends stand on neighbouring faces of a chord that is not round, and both
/// reach into the rounding between these faces but not past the edge where the faces would meet:
/// two rails as wide as the post at whose corner they meet. If both followed the rounding, they
/// would run into each other there, so they end flat on the faces.
[[nodiscard]] bool share_corner(const EndOf& a, const EndOf& b, const Member& chord);

/// A chord whose corner an end shares with an end of another member.
struct SharedCorner {
  std::size_t chord, other;
};
/// The shared corners of each end.
using SharedCorners = std::vector<std::vector<SharedCorner>>;
/// Finds them; whether the two ends join each other does not matter.
/// Cost  linear in the members, and in the pairs of ends at one chord.
[[nodiscard]] SharedCorners shared_corners(const Joints& joints);

/// Returns true if an end meets squarely two sections that are mitred with each other there,
/// whose faces towards it are flush: a post on the corner of a frame. It ends flat on both, because
/// the roundings of the two meet under it.
[[nodiscard]] bool flush_at_mitre(const Joints& joints, std::size_t end,
                                  const std::pair<std::size_t, std::size_t>& chords);

}  // namespace tubecut::joint::detail
