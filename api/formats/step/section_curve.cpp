#include "api/formats/step/section_curve.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {

using Eigen::Vector3d;
using section::Station;

constexpr double kNotFlat = 1e-7;  // mm, of four points from a plane
constexpr double kNoTurn = 1e-9;   // rad: below it an edge is a line

double turned(const Station& from, const Station& to) {
  return std::remainder(to.nu - from.nu, kTwoPi);
}

Brep::Points curve_between(const Vector3d& p, const Vector3d& q, const Station& from,
                           const Station& to, double radius) {
  const double angle = turned(from, to);
  if (std::abs(angle) <= kNoTurn) return {p, q};
  const double handle = 4.0 / 3.0 * elementary::tan(angle / 4.0);
  const auto tangent = [&](const Station& at) {
    return Vector3d(-radius * at.normal.y(), radius * at.normal.x(), (q.z() - p.z()) / angle);
  };
  return {p, p + handle * tangent(from), q - handle * tangent(to), q};
}

Brep::Points as_cubic(const Brep::Points& curve) {
  if (curve.size() == 4) return curve;
  const Vector3d third = (curve[1] - curve[0]) / 3.0;
  return {curve[0], curve[0] + third, curve[1] - third, curve[1]};
}

std::optional<Brep::Plane> plane_of(const std::vector<Vector3d>& corners) {
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  normal.normalize();
  for (const auto& p : corners)
    if (std::abs((p - corners[0]).dot(normal)) > kNotFlat) return std::nullopt;
  return Brep::Plane{corners[0], normal};
}

}  // namespace tubecut::api
