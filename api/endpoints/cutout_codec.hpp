#pragma once

#include <vector>

#include "api/endpoints/tube_laser.hpp"
#include "api/verdict.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// `cutouts` of a part, with what it has once: tube, kerf, torch and sampling.
[[nodiscard]] part::CutoutSpecs decode_cutouts(Reader& in, Preset preset,
                                               const bevel::TableSpec& once);

/// `cutouts` and `cutout_report` of an answer; nothing where none were requested.
void encode_cutouts(const part::PartSpec& spec, const part::Part& part, bool seam_known, Writer& w);
/// Returns the place of each instance in that answer, counted through all groups.
[[nodiscard]] std::vector<std::size_t> places_in_answer(const cutout::Layout& layout);
[[nodiscard]] std::vector<Measure> measures_of_cutouts(const part::PartSpec& spec,
                                                       const part::Part& part, bool seam_known);

}  // namespace tubecut::api
