#pragma once

#include <cstddef>

#include "core/bevel/section/section_surface.hpp"

namespace tubecut::bevel {

/// Returns how deep a round beam about the table's torch axis enters the finished surface at a
/// fraction of the way from a row to the next, mm; negative: how far it could come nearer. Computed
/// in space, from the cylinder's own directions: on a flat over its edges, straight from row to
/// row, else over sampled lines across the wall.
/// Accuracy  of a flat with straight edges 1e-3 of the kerf; never more than the depth is.
[[nodiscard]] double beam_depth(const SectionSurface& surface, const SectionTable& table,
                                std::size_t row, double share, double kerf);

}  // namespace tubecut::bevel
