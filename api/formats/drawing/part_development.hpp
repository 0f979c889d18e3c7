#pragma once

#include <string>
#include <vector>

#include "api/formats/drawing/sheet.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// A segment of the tube on a strip of paper.
struct StripSegment {
  double from = 0.0, to = 0.0;  // z
  double at = 0.0;              // of `from` on paper, from the strip's left edge
};

/// Layout of a part's outside laid flat on paper: true to shape, at one usual scale, as seen from
/// outside (z to the right, hence phi downwards, because x, y, z is right-handed). It is cut open
/// away from holes. Plain lengths are omitted, with a break; if it is too long, it continues on the
/// next strip.
struct DevelopmentPlan {
  using Strip = std::vector<StripSegment>;

  DrawingScale scale;
  double opened = 0.0;  // phi at the upper edge
  double girth = 0.0;   // mm on the tube
  std::vector<Strip> strips;

  /// Returns the height of a strip on the page, mm.
  [[nodiscard]] double height() const;
};

/// For strips `width` mm wide.
[[nodiscard]] DevelopmentPlan plan_development(const part::PartSpec& spec, const part::Part& part,
                                               double width);

/// The strip `index`: both ends with their partners in colours, holes by their tags, marks, the
/// datum line, quarters of the girth with their lengths; below it how far from the start's long
/// point everything begins and ends. Its upper left corner at `at`.
void draw_strip(Canvas& canvas, const DevelopmentPlan& plan, std::size_t index,
                const part::PartSpec& spec, const part::Part& part, DrawingPoint at);

}  // namespace tubecut::api
