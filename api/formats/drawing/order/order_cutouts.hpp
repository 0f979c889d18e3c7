#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/formats/drawing/order/order_sheets.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// Each cut-out as requested, in a pattern its first one: size, place, wall, and how it is
/// repeated.
void draw_cutouts(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part);
/// Of a part that is not round: places are on faces.
void draw_cutouts(OrderSheets& sheets, const part::SectionPartSpec& spec,
                  const part::SectionPart& part);

/// A step of a work order for several cut-outs.
struct CutoutRun {
  std::string text;
  std::size_t count = 0;  // of steps
};
/// Returns the cut-outs of one request, three or more, that follow each other from step `first` on;
/// nothing if there are none.
[[nodiscard]] std::optional<CutoutRun> cutout_run(const std::vector<part::Step>& all,
                                                  std::size_t first, const part::CutoutSpecs& specs,
                                                  const cutout::Layout& layout);

}  // namespace tubecut::api
