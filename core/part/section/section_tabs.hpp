#pragma once

#include <vector>

#include "core/part/section/section_part.hpp"

/// Tabs on the cut end of a tube that is not round.
namespace tubecut::part {

/// Tabs, and the end that they belong to.
struct TabbedEnd {
  const section::Wall& wall;
  const bevel::TableSpec& cut;
  const std::vector<EndTab>& tabs;
  bool finish;
};

/// Adds tabs to an end whose table is made: its table becomes the shoulder's. At each side of a tab
/// two rows have the same place: where the finished edge steps, and half a kerf next to it where
/// the torch does.
///
/// Errors  at end_tabs/i: out_of_range (width: beyond the flat, with the beam next to it; offset: the
///         beam does not pass between two tabs); unsupported_combination (groove: not square;
///         end_tabs/i: the cut bends on the tab).
/// Source  docs/theory/cutouts.md, section 10.
[[nodiscard]] Result<void> add_tabs(const TabbedEnd& end, SectionEnd& out);

/// Verifies the tabs from the rows in space: where their corners lie, that the beam passes next to
/// them by half a kerf, and that they take up their own area and no other.
[[nodiscard]] std::vector<Check> verify_tabs(const TabbedEnd& end, const SectionEnd& cut);

}  // namespace tubecut::part
