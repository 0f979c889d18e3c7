#pragma once

#include "api/formats/drawing/order/order_sheets.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

// The tables of a work order, each with its head, and fields for measurements and signatures.

/// Draws the members of a frame for which the pieces are, as many as fit on three lines; nothing
/// without a frame.
void draw_members(OrderSheets& sheets, const Caption& caption);

/// Draws each hole by its tag: its position from the start's long point and round from the datum
/// line, its size, its bevel.
void draw_holes(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part);

/// What is set at a tube notcher for each round partner of an end, where a shop has no torch for
/// it.
void draw_notches(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part,
                  const Caption& caption);

/// Draws the check dimensions, on one sheet if they fit, with the mistakes that change them.
void draw_checks(OrderSheets& sheets, const std::vector<part::CheckDimension>& dimensions);

/// What is done to the blank, in its order; several cut-outs of one request are one step.
[[nodiscard]] std::vector<std::string> step_texts(const part::PartSpec& spec,
                                                  const part::Part& part);
void draw_steps(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part);

}  // namespace tubecut::api
