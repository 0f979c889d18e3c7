#pragma once

#include <string>

#include "api/formats/step/brep.hpp"
#include "api/formats/step/step_solid.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// Returns a finished part that is not round as a solid, in the part's frame: the flats of both
/// walls are planes, their corners cylinders. Each gap between two rows of a cut is one face,
/// straight in (s, z) along both edges as the answer is; rows in line on a flat make one gap, and
/// an end that is square to the axis is one plane.
/// Accuracy  edges within 1e-6 mm of the answer's lines.
/// Errors  throws UnfitOption if a corner, outside or of the bore, has no radius.
[[nodiscard]] Brep section_solid(const part::SectionPartSpec& spec, const part::SectionPart& part);

/// Returns the file's name for a tube of this section: the reference's part takes precedence over
/// `member`.
[[nodiscard]] Product product_of(const section::Section& section, const std::string& member,
                                 const Caption& caption);

}  // namespace tubecut::api
