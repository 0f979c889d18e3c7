#pragma once

#include <stop_token>

#include "core/bevel/hole/hole.hpp"
#include "core/math/polygon.hpp"

namespace tubecut::bevel {

/// A hole's line on the cylinder between, developed to (phi, z), the share u of the way from the
/// bore out: where the straight lines from edge to edge pass it. `turn` is added to phi. Told to
/// stop, it has some of its corners, or none.
[[nodiscard]] math::Polygon slice(const joint::Target& target, const Hole& hole, double u,
                                  double turn, const std::stop_token& stop);

}  // namespace tubecut::bevel
