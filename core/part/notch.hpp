#pragma once

#include <vector>

#include "core/part/part.hpp"

namespace tubecut::part {

/// The settings of a tube notcher (a hole saw on an angle plate) for one round partner of an end.
/// Lengths in mm, angles in rad.
struct Notch {
  bool finish = false;
  std::size_t partner = 0;      // of the end
  double saw_diameter = 0.0;    // the partner's outer diameter
  double angle = 0.0;           // between the axes, measured from perpendicular: 0 at right angles
  double offset = 0.0;          // between the axes, >= 0
  double offset_towards = 0.0;  // phi of the part on whose side the partner's axis passes
  double depth = 0.0;  // along the tube, from the end's long point to the partner's throat, outside
  double rotation =
      0.0;  // of the tube in its clamp, from the first notch on, positive in the direction of phi
};

/// Returns a notch for every round partner that a welded end is set on; start before finish. The
/// rotation goes between the sides to which the partners lean, in (-180, 180] deg. A partner at
/// right angles leans both ways, so the smaller rotation counts, in (-90, 90].
///
/// Accuracy  depth within 1e-6 mm of the contours on the outer wall, which a hole saw leaves
///           regardless of the bevel in the part's own table.
/// Cost      1440 phases each.
[[nodiscard]] std::vector<Notch> notches(const PartSpec& spec, const Part& part);

}  // namespace tubecut::part
