#pragma once

#include "api/endpoints/tube_laser.hpp"
#include "api/wire/reader.hpp"
#include "core/part/part.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// Decodes the fields of a contour, or the text of a drawing with one contour; what is wrong with
/// that is an issue of its text.
[[nodiscard]] cutout::Contour decode_contour_shape(Reader& in);
[[nodiscard]] cutout::Contour decode_dxf_shape(Reader& in);

/// Decodes `cutouts` and `texts` of a part, with the values that it has once: tube, kerf, torch and
/// sampling. `section`: of a tube that is not round, else nullptr. `sure`: the tube's own fields
/// were understood; else places round it are not held against its kind.
[[nodiscard]] part::CutoutSpecs decode_cutouts(Reader& in, Preset preset,
                                               const bevel::TableSpec& once,
                                               const section::Section* section, bool sure);

}  // namespace tubecut::api
