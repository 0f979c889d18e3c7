#pragma once

#include <string>

#include "api/formats/dxf/plate_dxf.hpp"
#include "api/formats/step/step_solid.hpp"

namespace tubecut::api {

/// Returns a plate as a solid in its own frame: its face at z = 0, the metal below; a plane for
/// each line of its contours, one or two cylinders for each arc, without an approximation.
[[nodiscard]] Brep plate_solid(const PlateDrawing& plate);
/// Returns the file's name for a plate: the reference's part takes precedence over its own.
[[nodiscard]] Product product_of(const PlateDrawing& plate, const Caption& caption);
/// Returns the plate as ISO 10303-21 text.
[[nodiscard]] std::string print_plate_step(const PlateDrawing& plate, const Caption& caption);

}  // namespace tubecut::api
