#include "core/joint/generator.hpp"

#include "core/base/elementary.hpp"

namespace tubecut::joint {

using Eigen::Vector3d;

Generator generator_at(double radius, double phi) {
  const auto at = elementary::sincos(phi);
  return {radius, at.cos, at.sin};
}

Hit hit_on(const SurfaceAt& surface, const Eigen::Matrix3d& rows, const Generator& line) {
  const Vector3d radial = rows * Vector3d(line.cos_phi, line.sin_phi, 0.0);
  const Vector3d round = rows * Vector3d(-line.sin_phi, line.cos_phi, 0.0);
  Hit out;
  out.z = surface.z;
  out.normal = {surface.gradient.dot(radial), surface.gradient.dot(round), surface.steep};
  out.z_dphi = -line.radius * out.normal.y() / surface.steep;
  out.axial = surface.axial;
  return out;
}

}  // namespace tubecut::joint
