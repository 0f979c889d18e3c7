#pragma once

#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// A 1:1 template to wrap round the tube: the cut's edges on both walls, the torch's line, partners
/// by name, marks, seam with a tab to glue, datum, phi scale, a 100 mm check ruler each way and the
/// part's mark. On one sheet as large as it is, or with the option `paper` in tiles (tiles.hpp).
///
/// Everything is drawn at its phi on the outer surface: x = outer radius * phi, y = z, of an end
/// the kept side up. As drawn it reads with the print side out; `mirror` turns it for the print
/// side to lie on the tube.
[[nodiscard]] std::vector<Canvas> wrap_template(const Development& development,
                                                const Caption& caption);

/// Throws UnfitOption if the view is not a template and `paper` is a page's.
void refuse_paper(const Caption& caption);

}  // namespace tubecut::api
