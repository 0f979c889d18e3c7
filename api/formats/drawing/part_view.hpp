#pragma once

#include "api/formats/drawing/sheet.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// The part in space, parallel, its axis to the right and back: what is seen of the outside, of the
/// start's cut, of the bore and of the holes, each edge in its partner's colour; the datum line,
/// the way that phi grows, the holes' names. Long plain stretches are drawn shorter, with a break.
/// A picture: edges are taken at 180 phases.
void draw_part_view(Canvas& canvas, const part::PartSpec& spec, const part::Part& part,
                    const Cell& room);

}  // namespace tubecut::api
