#pragma once

#include <cstddef>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/bevel/beam/beam.hpp"

namespace tubecut::bevel::beam {

/// Runs of rows near which, within half a kerf, the torch leans in ways that are apart: there a
/// place where the beam is in the part can be narrow across the wall. Beams of an end pass one
/// another by phase, those of a hole any way.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> swings(const BeamCut& cut,
                                                                      const std::stop_token& stop);

}  // namespace tubecut::bevel::beam
