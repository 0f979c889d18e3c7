#pragma once

#include "core/bevel/table/table.hpp"

namespace tubecut::part {

/// Computes the volume of the wall below an end's cut, down to z = 0, with a root face in three
/// edges. mm^3.
/// Accuracy  exact for edges straight between their nodes and straight across the wall.
/// Source    docs/theory/parts.md, section 3.
[[nodiscard]] double end_volume(const bevel::TableSpec& spec, const bevel::Table& table);

/// Computes the volume between an end's cut and its partners' metal, within the wall's thickness:
/// the filler metal of a weld that ends flush with the outside. In the end's own frame, mm^3. A
/// generator that meets no partner adds 0.
/// Accuracy  1e-3 of itself: Gauss' rules along the cut, straight from row to row, and across it.
/// Cost      about 0.4 ms; linear in rows and in partners. If cancelled, the value has no meaning.
[[nodiscard]] double groove_volume(const bevel::TableSpec& spec, const bevel::Table& table);

}  // namespace tubecut::part
