#pragma once

#include <span>
#include <vector>

#include "core/joint/section/section_contour.hpp"

namespace tubecut::joint {

/// Returns the true length from the datum to each of the ascending places (s, [0, girth)); at a
/// jump the height difference counts after the first of two equal places. One more entry than
/// places: the last is the length of the whole closed curve.
/// Accuracy  1e-9 of the length.
/// Source    docs/theory/sections.md, section 2.4.
[[nodiscard]] std::vector<double> lengths_along(const SectionContour& contour,
                                                std::span<const double> places);

}  // namespace tubecut::joint
