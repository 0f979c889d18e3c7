#pragma once

#include <Eigen/Core>

namespace tubecut::joint {

/// If sin(inclination) is below it, a partner counts as parallel to the target: 5.73e-5 deg.
inline constexpr double kParallel = 1e-6;

/// The relative distance beyond a silhouette at which a generator still touches: a quarter of the
/// limit of the answer's own verification.
inline constexpr double kTouch = 2.5e-13;

/// A straight line on the target, parallel to its axis, with the sine and cosine that all cutters
/// share.
struct Generator {
  double radius = 0.0;  // rho > 0, of the target surface
  double cos_phi = 1.0;
  double sin_phi = 0.0;
};
[[nodiscard]] Generator generator_at(double radius, double phi);

/// The point where a generator of the target leaves a cutter upwards. `normal` is the cutter's
/// outward unit normal as (radial, tangential, axial) of the target. At a silhouette its axial part
/// is 0 and `z_dphi` infinite.
struct Hit {
  double z = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double z_dphi = 0.0;  // dz/dphi at constant radius, mm/rad
  double axial = 0.0;   // w, along the cutter's axis from the common perpendicular (plane: 0)
};

/// A surface at the point of a hit, in the partner's own frame: its unit gradient, and the
/// gradient's part along z, passed separately because the caller knows it more accurately.
struct SurfaceAt {
  double z = 0.0;
  Eigen::Vector3d gradient;
  double steep = 0.0;
  double axial = 0.0;
};
/// `rows` is the partner's frame in the target's frame.
[[nodiscard]] Hit hit_on(const SurfaceAt& surface, const Eigen::Matrix3d& rows,
                         const Generator& line);

}  // namespace tubecut::joint
