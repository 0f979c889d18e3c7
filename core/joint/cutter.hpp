#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "core/base/angle.hpp"

namespace tubecut::joint {

/// A round partner of the target, an infinite cylinder. Lengths in mm.
/// Frame: z along the target axis from the cut end into the kept member, phi from x towards y.
struct TubeCutter {
  double radius = 0.0;                // > 0
  Angle inclination = Angle::deg(90); // alpha, between the axes, open interval (0, 180) deg
  Angle clocking = {};                // beta, of the common perpendicular
  double offset = 0.0;                // s, signed distance of the axes
  double height = 0.0;                // h, where the common perpendicular meets the target axis
};

/// A plane as partner: the target is cut along it, material on the side its normal points to is kept.
struct PlaneCutter {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // any length > 0; turned so that its z is positive
};

using Cutter = std::variant<TubeCutter, PlaneCutter>;

/// Where a generator of the target leaves a cutter upwards.
struct Hit {
  double z = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // outward unit normal of the cutter: (radial, tangential, axial) of the target
  double z_dphi = 0.0;                                // dz/dphi at constant radius, mm/rad
};

}  // namespace tubecut::joint
