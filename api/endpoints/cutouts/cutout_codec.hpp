#pragma once

#include "api/endpoints/tube_laser.hpp"
#include "api/wire/reader.hpp"
#include "core/part/part.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// Decodes `cutouts` and `texts` of a part, with the values that it has once: tube, kerf, torch and
/// sampling. `section`: of a tube that is not round, else nullptr. `sure`: the tube's own fields
/// were understood; else places round it are not held against its kind.
[[nodiscard]] part::CutoutSpecs decode_cutouts(Reader& in, Preset preset,
                                               const bevel::TableSpec& once,
                                               const section::Section* section, bool sure);

}  // namespace tubecut::api
