#pragma once

#include "api/formats/drawing/order_sheets.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

// The tables of a work order, each with its head, and room for what was measured or done.

/// Which members of a frame the pieces are for, as many as stand on three lines; nothing where
/// there is no frame.
void draw_members(OrderSheets& sheets, const Caption& caption);

/// Each hole by its tag: where it is from the start's long point and round from the datum line, how
/// large, its bevel.
void draw_holes(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part);

/// What is set at a tube notcher for each round partner of an end, where a shop has no torch for
/// it.
void draw_notches(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part,
                  const Caption& caption);

/// The check dimensions, on one sheet where they fit, with the mistakes that change them.
void draw_checks(OrderSheets& sheets, const part::Part& part);

/// What is done to the blank, in its order.
void draw_steps(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part);

}  // namespace tubecut::api
