#pragma once

#include "core/bevel/hole/hole.hpp"
#include "core/math/polygon.hpp"

namespace tubecut::bevel {

/// Returns a hole's line on the intermediate cylinder at the fraction u from the bore out,
/// developed to (phi, z): where the straight lines from edge to edge cross it. `turn` is added to
/// phi. If cancelled, returns some or no corners.
[[nodiscard]] math::Polygon slice(const joint::Target& target, const Hole& hole, double u,
                                  double turn);

}  // namespace tubecut::bevel
