#pragma once

#include <string>

#include "api/formats/step/brep.hpp"
#include "core/cutout/cutout.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// The border of a cut-out on both sides of the wall, the metal to the left as seen from outside
/// the solid.
struct CutoutBorder {
  int face = 1;  // of the section
  Brep::Loop outside, bore;
};

/// Adds the wall of a cut-out on a flat to a solid: a plane for each line of its chain, one or two
/// cylinders for each arc, without an approximation.
[[nodiscard]] CutoutBorder add_cutout(const section::Wall& wall, const cutout::Layout& layout,
                                      const cutout::Instance& one, const std::string& name,
                                      Brep& solid);

}  // namespace tubecut::api
