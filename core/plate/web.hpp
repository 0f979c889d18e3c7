#pragma once

#include "core/cutout/chain.hpp"

/// Distances and positions of closed chains of lines and arcs in one plane, by closed forms.
namespace tubecut::plate {

/// Returns the least distance of two chains, mm; 0 if they cross or touch.
[[nodiscard]] double gap(const cutout::Chain& a, const cutout::Chain& b);

/// Returns true if the chain encloses the place, by its winding number.
[[nodiscard]] bool encloses(const cutout::Chain& chain, const cutout::Flat& place);

/// Returns the least distance of the boxes of two chains, mm; 0 if the boxes meet.
[[nodiscard]] double box_gap(const cutout::Bounds& a, const cutout::Bounds& b);

/// Moves a chain.
[[nodiscard]] cutout::Chain moved(cutout::Chain chain, const cutout::Flat& by);

}  // namespace tubecut::plate
