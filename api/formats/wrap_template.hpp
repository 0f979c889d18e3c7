#pragma once

#include <string>

#include "api/format.hpp"
#include "api/formats/development.hpp"

namespace tubecut::api {

/// A 1:1 template to wrap round the tube, as SVG in millimetres: the cut's edges on both walls, the
/// torch's line, seam, datum, phi scale, a 100 mm check ruler each way and the part's mark.
///
/// Everything is drawn at its phi on the outer surface: x = outer radius * phi, y = z, the kept
/// side up. As drawn it reads with the print side out; `mirror` turns it for the print side to lie
/// on the tube.
[[nodiscard]] std::string print_wrap_template(const Development& development,
                                              const Caption& caption);

}  // namespace tubecut::api
