#pragma once

#include <vector>

#include "api/verdict.hpp"
#include "api/wire/writer.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// The cut-outs of a part, round or not.
struct CutoutsOfPart {
  const part::CutoutSpecs& specs;
  const cutout::Layout& layout;
  const part::CutoutReport& report;
  double radius;   // mm; of a section, that of the circle that is as long as its girth
  double wall;     // mm
  double density;  // kg/m^3
  double longest;  // mm, of the part
  const section::Section* section;  // nullptr of a round tube
};
[[nodiscard]] CutoutsOfPart cutouts_of(const part::PartSpec& spec, const part::Part& part);
[[nodiscard]] CutoutsOfPart cutouts_of(const part::SectionPartSpec& spec,
                                       const part::SectionPart& part);

/// Writes `cutouts` and `cutout_report` of an answer; nothing if none were requested.
void encode_cutouts(const CutoutsOfPart& part, bool seam_known, Writer& w);
/// Returns the place of each instance in that answer, counted through all groups.
[[nodiscard]] std::vector<std::size_t> places_in_answer(const cutout::Layout& layout);
/// Returns the values that `accept` limits.
[[nodiscard]] std::vector<Measure> measures_of_cutouts(const CutoutsOfPart& part, bool seam_known);

}  // namespace tubecut::api
