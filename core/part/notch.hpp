#pragma once

#include <vector>

#include "core/part/part.hpp"

namespace tubecut::part {

/// What is set at a tube notcher (a hole saw on an angle plate) for one round partner of an end.
/// Lengths in mm, angles in rad.
struct Notch {
  bool finish = false;
  std::size_t partner = 0;      // of the end
  double saw_diameter = 0.0;    // the partner's outer diameter
  double angle = 0.0;           // between the axes, counted from perpendicular: 0 at right angles
  double offset = 0.0;          // between the axes, >= 0
  double offset_towards = 0.0;  // phi of the part on whose side the partner's axis passes
  double depth = 0.0;  // along the tube, from the end's long point to the partner's throat, outside
  double rotation = 0.0;  // of the tube in its clamp, from the first notch on, the way phi grows
};

/// Of every round partner that a welded end is set on; start before finish. The rotation goes from
/// side to side towards which the partners lean, in (-180, 180] deg; of one at right angles, which
/// leans to both, the smaller turn counts, in (-90, 90].
///
/// Accuracy  depth within 1e-6 mm of the contours on the outer wall, which a hole saw leaves
///           whatever bevel the part's own table has.
/// Cost      1440 phases each.
[[nodiscard]] std::vector<Notch> notches(const PartSpec& spec, const Part& part);

}  // namespace tubecut::part
