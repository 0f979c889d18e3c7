#pragma once

#include <string>
#include <vector>

#include "api/formats/gcode/gcode_header.hpp"

namespace tubecut::api {

/// The cuts as JSON: for each, from its pierce to the end of its lead-out, the points at which the
/// torch's line meets the outer and the inner wall. Between two pairs both points move linearly in
/// (phi, z). docs/formats.md, "Point pairs".
///
/// Frame     the result's: z along the tube, phi from x towards y.
/// Errors    throws UnfitOption (post) if the line grazes the inner wall.
/// Accuracy  1e-6 mm, 1e-6 deg.
[[nodiscard]] std::string print_point_pairs(const TorchJob& job,
                                            const std::vector<TorchCutPlaces>& cuts,
                                            const Straightness& moves, const Caption& caption);

}  // namespace tubecut::api
