#pragma once

#include "api/wire/writer.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// Writes `marks` of a part's answer, of a text with its strokes.
/// `radius`: outside, mm.
void encode_marks(const part::Part& part, double radius, Writer& w);
void encode_marks(const part::SectionPart& part, Writer& w);

}  // namespace tubecut::api
