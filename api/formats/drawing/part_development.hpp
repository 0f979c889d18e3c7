#pragma once

#include <string>
#include <vector>

#include "api/formats/drawing/sheet.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// How a part's outside is laid flat on paper: true to shape, at one usual scale, as it is seen
/// from outside (z to the right, hence phi downwards, for x, y, z is right-handed). It is cut open
/// where no hole is. Plain stretches are left out, with a break; what is too long goes on in the
/// next strip.
struct DevelopmentPlan {
  struct Stretch {
    double from = 0.0, to = 0.0;  // z
    double at = 0.0;              // of `from` on paper, from the strip's left edge
  };
  using Strip = std::vector<Stretch>;

  DrawingScale scale;
  double opened = 0.0;  // phi at the upper edge
  double girth = 0.0;   // mm on the tube
  std::vector<Strip> strips;

  /// What a strip takes of the page, mm.
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
