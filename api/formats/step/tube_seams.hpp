#pragma once

#include <array>
#include <vector>

#include "api/formats/mesh/tube_solid.hpp"

namespace tubecut::api {

/// Returns the two phases, ascending, at which the halves of a tube meet: at least a sixth of a
/// revolution between them, through as few holes as possible, not along a side of a hole or along a
/// cut.
[[nodiscard]] std::array<double, 2> tube_seams(double inner, double outer,
                                               const std::vector<TubeCut>& cuts);

}  // namespace tubecut::api
