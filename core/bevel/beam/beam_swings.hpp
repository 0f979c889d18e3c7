#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/bevel/beam/beam.hpp"

namespace tubecut::bevel::beam {

/// Returns the runs of rows near which, within half a kerf, the torch leans differently. There, a
/// spot where the beam is in the part can be narrow across the wall. Beams of an end pass one
/// another by phase, those of a hole in any direction.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> swings(const BeamCut& cut);

}  // namespace tubecut::bevel::beam
