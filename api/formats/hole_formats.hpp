#pragma once

#include <string>

#include "api/format.hpp"
#include "core/bevel/hole.hpp"

namespace tubecut::api {

/// Every column of every hole; the first names its side of the chord.
[[nodiscard]] std::string hole_csv(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

/// The holes on the chord's developed outer surface, finished edges and torch line, and the gap
/// over the branch's phase. The views `template` and `section`: see wrap_template.hpp,
/// sections.hpp.
[[nodiscard]] std::string hole_svg(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

/// The views `template` and `section` again, on pages.
[[nodiscard]] std::string hole_pdf(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

/// The holes on the developed chord; view `tube`: on the chord in space.
[[nodiscard]] std::string hole_dxf(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

}  // namespace tubecut::api
