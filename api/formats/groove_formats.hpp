#pragma once

#include <string>

#include "api/wire/format.hpp"
#include "core/groove/groove.hpp"
#include "core/groove/mill_path.hpp"

namespace tubecut::api {

/// One row per section.
[[nodiscard]] std::string groove_csv(const groove::GrooveSpec&, const groove::Groove&,
                                     const Caption&);
/// Returns the groove height over the section and, with a fixed bevel, the filler areas;
/// ?view=section: see groove_section_sheet.hpp.
[[nodiscard]] std::string groove_svg(const groove::GrooveSpec&, const groove::Groove&,
                                     const Caption&);
/// The groove surface, coloured by the twist of its rulings.
[[nodiscard]] std::string groove_gltf(const groove::GrooveSpec&, const groove::Groove&,
                                      const Caption&);

/// One row per emitted position.
[[nodiscard]] std::string mill_path_csv(const groove::MillPathSpec&, const groove::MillPath&,
                                        const Caption&);
/// Over- and undercut before and after over the section, and the axes.
[[nodiscard]] std::string mill_path_svg(const groove::MillPathSpec&, const groove::MillPath&,
                                        const Caption&);
/// The groove surface, coloured by the gap that each position leaves; nodes `before` and `after`.
[[nodiscard]] std::string mill_path_gltf(const groove::MillPathSpec&, const groove::MillPath&,
                                         const Caption&);

}  // namespace tubecut::api
