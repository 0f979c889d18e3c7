#pragma once

#include <array>
#include <stop_token>
#include <vector>

#include "api/formats/mesh/tube_solid.hpp"

namespace tubecut::api {

/// The two phases, ascending, at which the halves of a tube meet: a sixth of the turn apart or
/// more, through as few holes as can be, along no side of one and along no cut.
[[nodiscard]] std::array<double, 2> tube_seams(double inner, double outer,
                                               const std::vector<TubeCut>& cuts,
                                               const std::stop_token& stop);

}  // namespace tubecut::api
