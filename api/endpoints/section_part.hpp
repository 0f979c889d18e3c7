#pragma once

#include <vector>

#include "api/endpoints/part_request.hpp"
#include "api/verdict.hpp"
#include "api/wire/writer.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// Returns the values that `accept` limits.
[[nodiscard]] std::vector<Measure> measures_of(const PartRequest& spec,
                                               const part::SectionPart& part);

/// Writes the members of the `result` of a part that is not round.
void encode_part(const PartRequest& spec, const part::SectionPart& part, Writer& w);

}  // namespace tubecut::api
