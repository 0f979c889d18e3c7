#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/joint/sampling.hpp"
#include "core/joint/section/section_contour.hpp"

namespace tubecut::joint {

enum class SectionNodeKind { smooth, junction, jump, kink, seam };

/// One point of the sampled contour. At a junction or kink the cutters just before and after s
/// hold; a jump is two nodes of the same s, each with one cutter.
struct SectionNode {
  double s = 0.0;  // mm, [0, girth)
  double z = 0.0;
  std::size_t before = 0;
  std::size_t after = 0;
  SectionNodeKind kind = SectionNodeKind::smooth;
  double length = 0.0;  // true length from the datum, mm
};

struct SectionSamples {
  std::vector<SectionNode> nodes;  // ascending s; the closing point is not repeated
  double true_length = 0.0;        // of the exact curve, mm
};

/// Samples a contour as `sample` does for a round target: with a tolerance every event, seams
/// included, and every place of `also` (s, [0, girth)) is a node. Uniform points alone are the bare
/// grid s_i = i girth / n.
///
/// Errors    too_many_nodes (sampling), cancelled, out_of_range.
/// Source    docs/theory/sections.md, section 2.4.
[[nodiscard]] Result<SectionSamples> sample(const SectionContour& contour, const Sampling& sampling,
                                            std::span<const double> also = {});

}  // namespace tubecut::joint
