#pragma once

#include "api/formats/drawing/canvas.hpp"
#include "api/wire/format.hpp"
#include "core/groove/groove.hpp"

namespace tubecut::api {

/// Returns sections of a groove through the branch axis on A4, all at one usual scale: branch,
/// chord and filler at the section of ?omega_deg, with its points and areas; else eight sections
/// round it, with a table of their figures.
[[nodiscard]] Canvas groove_section_sheet(const groove::GrooveSpec& spec,
                                          const groove::Groove& groove, const Caption& caption);

}  // namespace tubecut::api
