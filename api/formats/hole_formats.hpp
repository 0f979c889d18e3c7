#pragma once

#include <string>

#include "api/endpoint.hpp"
#include "core/bevel/hole.hpp"

namespace tubecut::api {

/// Every column of every hole; the first names its side of the chord.
[[nodiscard]] std::string hole_csv(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

/// The holes on the chord's developed outer surface, finished edges and torch line, and the gap
/// over the branch's phase.
[[nodiscard]] std::string hole_svg(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                   const Caption& caption);

}  // namespace tubecut::api
