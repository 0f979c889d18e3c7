#pragma once

#include "api/formats/drawing/sheet.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// Draws the part in space, in parallel projection, its axis to the right and back: the visible
/// part of the outside, of the start's cut, of the bore and of the holes, each edge in its
/// partner's colour; the datum line, the direction of phi, the holes' names. Long plain lengths are
/// shortened, with a break. Edges are sampled at 180 phases, which is enough for a picture.
void draw_part_view(Canvas& canvas, const part::PartSpec& spec, const part::Part& part,
                    const Cell& room);

}  // namespace tubecut::api
