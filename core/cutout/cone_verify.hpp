#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/cutout/cone.hpp"

/// A cone in space, about its anchor: x along the normal, from the tube's axis or, on a flat, from
/// its outside; y the way the outside grows; z along the tube.
namespace tubecut::cutout {

/// How far a place is off the finished wall, which is the cone or its circle, mm.
[[nodiscard]] double off_cone(const Laying& laying, const Cone& cone, const Eigen::Vector3d& place);

/// Places of the finished wall, about `apart` from each other round it.
[[nodiscard]] std::vector<Eigen::Vector3d> cone_places(const Laying& laying, const Cone& cone,
                                                       double apart);

/// What the cone takes beyond its circle, mm^3: on each ring of the wall by strips along the tube.
[[nodiscard]] double cone_by_rings(const Laying& laying, const Cone& cone);

}  // namespace tubecut::cutout
