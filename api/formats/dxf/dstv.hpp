#pragma once

#include <string>

#include "api/wire/format.hpp"
#include "core/bevel/table/table.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// The cut end as a DSTV NC file (.nc1) of a round tube (profile code RO: "Rounded Tube"; RU is a
/// round bar).
///
/// Returns a DSTV file. AK is the finished outer contour, developed on face v. The standard shows
/// its faces as the tool sees them, from outside, x to the right and y up: x along the tube from
/// the cut's long point, y = outer radius * (360 deg - phi), mm, because phi grows downwards in
/// this view. The length line has the length over the long point, then the saw length, which adds
/// the metal that the torch line removes beyond it. If the whole cut has one bevel, every point of
/// the cut carries it; else the angle columns are 0 and the header names the sidecar, the `csv`
/// format of the same request, whose B columns are in `**` lines too, with the inner contour,
/// because the format has one wall only and an IK block would be cut as a hole. Without `length_mm`
/// the far end is the solid's (cut_solid.hpp), and the header states this.
[[nodiscard]] std::string print_dstv(const bevel::TableSpec& spec, const bevel::Table& table,
                                     const Caption& caption);

/// A whole part: AK is the outside with both ends, an IK block each hole, x from the start's long
/// point. Angles and B as in the part: the outer edge further towards +x is positive.
[[nodiscard]] std::string print_dstv(const part::PartSpec& spec, const part::Part& part,
                                     const Caption& caption);

}  // namespace tubecut::api
