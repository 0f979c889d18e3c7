#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/cutout/cutout.hpp"

namespace tubecut::cutout {

/// Whether a kerf fits into the shape, by its own fields: shape/diameter, shape/width, ...
[[nodiscard]] std::vector<Issue> check_sizes(const Spec& spec, const Laying& laying, double kerf);

/// Whether the chain crosses the bore twice: open_profile.
[[nodiscard]] std::vector<Issue> check_open(const Chain& chain, const Laying& laying);

/// Whether a straight tool at the anchor passes a wall that is cut square from the bore:
/// unsupported_combination (wall).
[[nodiscard]] std::vector<Issue> check_straight_tool(const Laying& laying);

/// The least radius of a rectangle's corners on a section that the kerf allows wherever its pattern
/// puts it, mm: half the kerf on a flat, more over a corner. `chain` is the rectangle without them.
[[nodiscard]] double least_corner(const Spec& spec, const Chain& chain, const section::Wall& wall,
                                  double kerf);

/// The place furthest from the chain within it; of simple shapes its middle, of a slot the centre
/// of the end with the lower z.
[[nodiscard]] Flat deep_in(const Spec& spec, const Chain& chain);

}  // namespace tubecut::cutout
