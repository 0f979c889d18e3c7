#pragma once

#include <vector>

#include "api/wire/writer.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

// Members of a part's `result` that do not depend on its section.

void encode_lengths(const part::Lengths& lengths, Writer& o);
void encode_sequence(const std::vector<part::Step>& sequence, const cutout::Layout& cutouts,
                     Writer& w);
void encode_dimension(Writer& each, const part::CheckDimension& dimension);

}  // namespace tubecut::api
