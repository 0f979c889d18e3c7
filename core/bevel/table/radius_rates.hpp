#pragma once

#include <limits>

#include "core/joint/cutters/cutter.hpp"

namespace tubecut::bevel {

/// What a rate is where there is none.
inline constexpr double kNoRate = std::numeric_limits<double>::quiet_NaN();

/// By how many mm the root's z changes at one phi for each mm by which a radius is larger: what a
/// tube that is not round costs. Times the axial part of the partner's normal it is a gap.
struct RadiusRates {
  double branch = kNoRate;  // of the target, with its wall kept; along the tube at this phi
  double chord = kNoRate;   // of the partner; kNoRate of one without a radius: plane, box
};

/// At a point of the cut, where the partner's outward unit normal is `normal` = (radial,
/// tangential, axial of the target). A surface of radius rho (target) and R (partner) that stays
/// in contact keeps radial drho + axial dz = s dR, with s the way that the partner's surface moves
/// normal to itself for each mm of radius: 1 of a tube or elbow, the cosine of its half angle of a
/// cone. Both are kNoRate where the cut runs along the tube, at a partner's silhouette.
///
/// Accuracy  4 eps of the normal's own.
[[nodiscard]] RadiusRates radius_rates(const joint::PreparedCutter& partner,
                                       const Eigen::Vector3d& normal);

}  // namespace tubecut::bevel
