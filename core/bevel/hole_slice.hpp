#pragma once

#include "core/bevel/hole.hpp"
#include "core/math/polygon.hpp"

namespace tubecut::bevel {

/// A hole's line on the cylinder between, developed to (phi, z), the share u of the way from the
/// bore out: where the straight lines from edge to edge pass it. `turn` is added to phi.
[[nodiscard]] math::Polygon slice(const joint::Target& target, const Hole& hole, double u,
                                  double turn = 0.0);

}  // namespace tubecut::bevel
