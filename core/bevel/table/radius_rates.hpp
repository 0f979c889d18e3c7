#pragma once

#include <limits>

#include "core/joint/cutters/cutter.hpp"

namespace tubecut::bevel {

/// The value of an undefined rate.
inline constexpr double kNoRate = std::numeric_limits<double>::quiet_NaN();

/// The change of the root's z at one phi per mm of a radius: the effect of a tube that is not
/// round. Multiplied by the axial part of the partner's normal, it is a gap.
struct RadiusRates {
  double branch = kNoRate;  // of the target, with its wall kept; along the tube at this phi
  double chord = kNoRate;   // of the partner; kNoRate if it has no radius: plane, box
};

/// Computes the rates at a point of the cut, where the partner's outward unit normal is `normal` =
/// (radial, tangential, axial of the target). A surface of radius rho (target) and R (partner) that
/// stays in contact keeps radial drho + axial dz = s dR, with s the motion of the partner's surface
/// normal to itself per mm of radius: 1 for a tube or elbow, the cosine of its half angle for a
/// cone. Both are kNoRate if the cut runs along the tube, at a partner's silhouette.
///
/// Accuracy  4 eps of the normal's own.
[[nodiscard]] RadiusRates radius_rates(const joint::PreparedCutter& partner,
                                       const Eigen::Vector3d& normal);

}  // namespace tubecut::bevel
