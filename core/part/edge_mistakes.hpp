#pragma once

#include "core/part/edge.hpp"

/// Changes of an end's edges by single mistakes: see docs/theory/parts.md, section 4.
namespace tubecut::part {

/// Both edges of one end.
struct EndEdges {
  Edge* outer = nullptr;
  Edge* inner = nullptr;
};

/// Rotates the end by `by` (rad of the turn), after a mirroring if `mirror` is set.
void move_end(EndEdges end, bool mirror, double by);
/// Mirrors the edge without the root at the one with it, because B swings the wrong way.
void swing_wrong(EndEdges end, bool root_outer);
/// Extends the torch lines through a wall that is thicker by `factor`.
void thicken(double factor, EndEdges end);
/// Moves the cut along the tube by `factor` times its rise across the wall.
void shift_by_slope(double factor, EndEdges end);

}  // namespace tubecut::part
