#pragma once

#include <string>

#include "api/formats/drawing/development.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// Every column of every hole; the first names its side of the chord.
[[nodiscard]] std::string hole_csv(const NamedHole& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

// Each names the chord and the branch of the hole, if they have ids.

/// The holes on the chord's developed outer surface, finished edges and torch line, and the gap
/// over the branch's phase. The views `template` and `section`: see wrap_template.hpp,
/// sections.hpp.
[[nodiscard]] std::string hole_svg(const NamedHole& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

/// The views `template` and `section` again, on pages.
[[nodiscard]] std::string hole_pdf(const NamedHole& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

/// The holes on the developed chord; view `tube`: on the chord in space.
[[nodiscard]] std::string hole_dxf(const NamedHole& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

}  // namespace tubecut::api
