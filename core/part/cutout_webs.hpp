#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/part/cutout_report.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::part {

/// Checks that every cut-out lies within the part and clear of every other opening, and measures
/// the webs beside it on the developed outside and the developed bore.
///
/// Errors    cutout_off_part (cutouts/k/at/z, or cutouts/k/pattern), cutouts_cross (cutouts/k). All
///           of them at once, one a spec.
/// Accuracy  webs within 2 um: edges are chords that leave the exact ones by 1 um at most.
/// Source    docs/theory/cutouts.md, section 5.
[[nodiscard]] Result<CutoutReport> check_cutouts(const PartSpec& spec, const Part& part);
/// The same of a part that is not round: phases are shares of the girth of the wall in question.
[[nodiscard]] Result<CutoutReport> check_cutouts(const SectionPartSpec& spec,
                                                 const SectionPart& part);

/// How a hint names a hole: by its branch, else by its field of the request.
[[nodiscard]] std::string name_of(const HoleSpec& hole);

}  // namespace tubecut::part
