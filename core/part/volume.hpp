#pragma once

#include "core/bevel/table/table.hpp"

namespace tubecut::part {

/// Volume of the wall below an end's cut, down to z = 0, with a root face in three edges. mm^3.
/// Accuracy  exact for edges straight between their nodes and straight across the wall.
/// Source    docs/theory/parts.md, section 3.
[[nodiscard]] double end_volume(const bevel::TableSpec& spec, const bevel::Table& table);

/// Volume between an end's cut and its partners' metal, within the wall's thickness: what is filled
/// when the weld ends flush with the outside. In the end's own frame, mm^3. Where a generator
/// meets no partner it counts nothing.
/// Accuracy  1e-3 of itself: Gauss' rules along the cut, straight from row to row, and across it.
/// Cost      about 0.4 ms; linear in rows and in partners. Once stopped the value has no meaning.
[[nodiscard]] double groove_volume(const bevel::TableSpec& spec, const bevel::Table& table,
                                   const std::stop_token& stop = {});

}  // namespace tubecut::part
