#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/wire/format.hpp"
#include "core/cutout/chain.hpp"

namespace tubecut::api {

/// A plate as its files draw it: x to the right, y up, its face towards the eye. Lengths in mm.
struct PlateDrawing {
  struct Hole {
    std::string name;
    cutout::Chain chain;
    std::optional<double> diameter;  // of a circle
    cutout::Flat centre;
  };
  struct Mark {
    std::string name;  // of the tube that is set on there
    cutout::Chain outline;
    bool front = true;  // on the face
  };
  std::string name;
  double thickness = 0.0, density = 0.0, mass = 0.0;  // mm, kg/m^3, kg
  cutout::Chain outline;
  std::vector<Hole> holes;
  std::vector<Mark> marks;
};

/// A plate as DXF R2000 in millimetres: its outline on CUT_OUTER, its openings on CUT_INNER, on
/// MARK the outlines of the tubes set on its face, on TEXT their names and the captions.
/// Arcs are arcs (polylines with bulges), circles are circles.
[[nodiscard]] std::string print_plate_dxf(const PlateDrawing& plate, const Caption& caption);

/// A plate as a DSTV NC file (.nc1): profile code B, its outline as AK, bores as BO, other openings
/// as IK, all on face v, from the outline's lower left corner. Arcs are chords within 0.005 mm of
/// them, because other files of the service have no radii either.
[[nodiscard]] std::string print_plate_dstv(const PlateDrawing& plate, const Caption& caption);

}  // namespace tubecut::api
