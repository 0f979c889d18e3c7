#include "core/bevel/table/radius_rates.hpp"

#include <cmath>

namespace tubecut::bevel {
namespace {

/// Return the motion of the surface, normal to itself, per mm of radius.
double moved_by_radius(const joint::PreparedTube& /*tube*/) { return 1.0; }
double moved_by_radius(const joint::PreparedElbow& /*elbow*/) { return 1.0; }
double moved_by_radius(const joint::PreparedCone& cone) {
  return 1.0 / std::sqrt(1.0 + cone.slope * cone.slope);
}
double moved_by_radius(const joint::PreparedPlane& /*plane*/) { return kNoRate; }
double moved_by_radius(const joint::PreparedRectangularTube& /*box*/) { return kNoRate; }

}  // namespace

RadiusRates radius_rates(const joint::PreparedCutter& partner, const Eigen::Vector3d& normal) {
  constexpr double kSilhouette = 1e-9;  // a rate above 1e9 has no meaning
  const double axial = normal.z();
  if (!(axial > kSilhouette)) return {};
  const double moved =
      joint::by_kind(partner, [](const auto& kind) { return moved_by_radius(kind); });
  return {.branch = -normal.x() / axial, .chord = moved / axial};
}

}  // namespace tubecut::bevel
