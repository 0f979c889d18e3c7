#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/joint/solid.hpp"

namespace tubecut::bevel {

/// One edge of a cut wall: phi (rad) and z (mm) of each row at `radius` about the tube's axis.
struct WallEdge {
  double radius = 0.0;
  std::span<const double> phi, z;
};

/// A cut wall by its edges, innermost first. Between two rows every edge is straight in (phi, z),
/// because the machine interpolates its rows, and at each position along the rows the wall is
/// straight in space from one edge to the next. After the last row comes the first, `turn` (rad)
/// further on: 2 pi for an end, 0 for a hole.
struct CutWall {
  std::vector<WallEdge> edges;
  double turn = 0.0;

  [[nodiscard]] std::size_t gaps() const { return edges.front().phi.size(); }
};

/// The deepest point of a wall in any solid.
struct Penetration {
  double depth = 0.0;  // mm, normal to the solid; <= 0: nothing is entered, nearest point
  double phi = 0.0;    // rad
  double radius = 0.0, z = 0.0;
  std::size_t solid = 0;
};

/// Computes how deep the wall enters, at rows and between them: no point of it is deeper in any
/// solid than max(depth, 0) + `slack`, and the stated point has the stated depth.
///
/// The result is an enclosure, not a sample. Between two lines across the wall, curvature and edges
/// bound the decrease of the distance to a tube or plane. For other solids a tangent plane at the
/// middle of a part bounds it (a convex distance lies above it, an elbow's below it by at most its
/// hollow side). Parts that might be deeper are halved.
///
/// Errors  never; if cancelled, the search ends early and the bound does not hold.
/// Cost    one line a row and solid, and those of the parts that come within `slack` of the
///         deepest.
/// Source  docs/theory/intersections-and-bevels.md, section 5.7.
[[nodiscard]] Penetration deepest(const CutWall& wall, std::span<const joint::Solid> solids,
                                  double slack);

/// Returns the gaps (i: from row i to the next) in which the wall may enter a solid by more than
/// `limit`, by the same enclosure: none is missed; gaps within 2 % below it may be included.
[[nodiscard]] std::vector<bool> entering(const CutWall& wall, std::span<const joint::Solid> solids,
                                         double limit);

}  // namespace tubecut::bevel
