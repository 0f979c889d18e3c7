#pragma once

#include <vector>

#include "core/bevel/section/section_surface.hpp"

namespace tubecut::bevel::detail {

inline constexpr double kNarrow = 1e-4;  // mm: no rows nearer to each other

/// Returns the middles (s) of the gaps in which the needed drop leaves the straight line between
/// its rows by more than the sampling's tolerance. Incomplete if cancelled.
[[nodiscard]] std::vector<double> places_where_drop_bends(const SectionSurface& surface,
                                                          const TableSpec& spec,
                                                          const SectionTable& table);

/// Returns the places (s) at the steps of the finished edge between which the torch's axis
/// takes the step: the beam passes the step's wall at the first of each two, and is past it at the
/// second. Incomplete if cancelled.
[[nodiscard]] std::vector<double> places_of_steps(const SectionSurface& surface,
                                                  const TableSpec& spec, const SectionTable& table);

/// Fills the torch's axis by row and `torch_line`. The drop is straight from row to row, so rows
/// are lowered if it would fall short between them.
/// Errors  out_of_range (kerf): the beam enters the finished part all the same; cancelled.
[[nodiscard]] Result<void> lay_torch(const SectionSurface& surface, const TableSpec& spec,
                                     SectionTable& table);

}  // namespace tubecut::bevel::detail
