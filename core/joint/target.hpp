#pragma once

#include <optional>

namespace tubecut::joint {

/// The tube that is cut. Lengths in mm.
struct Target {
  double outer_radius = 0.0;          // > wall
  double wall = 0.0;                  // > 0
  std::optional<double> length = {};  // from the frame's origin; empty: the far end is not checked

  [[nodiscard]] double inner_radius() const { return outer_radius - wall; }
};

/// The target's wall; 0 < inner < outer, mm.
struct Wall {
  double inner = 0.0;
  double outer = 0.0;
};

}  // namespace tubecut::joint
