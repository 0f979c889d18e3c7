#pragma once

#include <cstddef>

#include "core/joint/node/node_parts.hpp"

namespace tubecut::joint::detail {

/// The corner radius of a chord whose faces count as meeting in an edge, mm.
inline constexpr double kSharpCorner = 0.01;

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

/// Returns true if an end of `other`, cut by the same chord, shares its corner with end `index`.
[[nodiscard]] bool shares_corner(const Joints& joints, std::size_t index, std::size_t other,
                                 std::size_t chord);

}  // namespace tubecut::joint::detail
