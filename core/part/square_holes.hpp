#pragma once

#include <optional>
#include <vector>

#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::part {

/// Adds square holes to the cut-outs of a part. Each has the name of its branch; if another cut-out
/// has it, a number is appended. `section`: of a part that is not round.
///
/// Errors  those of cutout::holes_for, at holes/i/branch.
[[nodiscard]] Result<void> add_square_holes(const std::vector<SquareHole>& holes,
                                            const joint::Target& tube,
                                            const std::optional<section::Section>& section,
                                            Angle zero, CutoutSpecs& out);

/// Verifies that the walls of square holes keep the gap to their branches, by the distances of
/// their rows in space: nowhere less than requested, and nowhere more than answered. Empty if there
/// are none.
[[nodiscard]] std::vector<Check> verify_square_holes(const PartSpec& spec, const Part& part);
[[nodiscard]] std::vector<Check> verify_square_holes(const SectionPartSpec& spec,
                                                     const SectionPart& part);

}  // namespace tubecut::part
