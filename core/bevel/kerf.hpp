#pragma once

#include <span>
#include <vector>

#include "core/joint/sampling.hpp"

namespace tubecut::bevel {

/// How far below the finished edge the torch axis runs at each node, mm along z, for a kerf of
/// width `kerf` measured normal to the cut: (kerf / 2) sqrt(1 + tan^2 B + tan^2 gamma) where the
/// curve is locally straight. Where it turns vertical that grows without bound, while a disc of the
/// kerf's radius never has to sink further than to the lowest point of the curve within its own
/// width: the smaller of the two is taken. Source  docs/theory/intersections-and-bevels.md,
/// section 5.6.
[[nodiscard]] std::vector<double> kerf_drops(const joint::Contour& contour,
                                             const joint::Samples& samples,
                                             std::span<const double> b,
                                             std::span<const double> gamma, double kerf);

}  // namespace tubecut::bevel
