#include "core/joint/solid.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::joint {

Solid::Solid(const Cutter& cutter) {
  if (const auto* tube = std::get_if<TubeCutter>(&cutter)) {
    const auto a = elementary::sincos(tube->inclination.rad());
    const auto b = elementary::sincos(tube->clocking.rad());
    point_ = {-tube->offset * b.cos, -tube->offset * b.sin, tube->height};
    direction_ = {a.sin * b.sin, -a.sin * b.cos, a.cos};
    radius_ = tube->radius;
  } else {
    const auto& plane = std::get<PlaneCutter>(cutter);
    point_ = plane.point;
    direction_ = plane.normal.normalized();
    if (direction_.z() < 0.0) direction_ = -direction_;
    plane_ = true;
  }
}

double Solid::distance(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d from = point - point_;
  return plane_ ? from.dot(direction_) : from.cross(direction_).norm() - radius_;
}

Eigen::Vector3d Solid::normal(const Eigen::Vector3d& point) const {
  if (plane_) return direction_;
  const Eigen::Vector3d from = point - point_;
  return (from - from.dot(direction_) * direction_).normalized();
}

std::optional<double> Solid::top(double x, double y) const {
  const Eigen::Vector3d from = Eigen::Vector3d(x, y, 0.0) - point_;
  if (plane_) return -from.dot(direction_) / direction_.z();
  // |(from + z e_z) - ((from + z e_z).d) d|^2 = r^2, a quadratic in z.
  const Eigen::Vector3d across = from - from.dot(direction_) * direction_;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - direction_.z() * direction_;
  const double a = up.squaredNorm();
  const double half_b = across.dot(up);
  const double gap = clearance(x, y);
  if (gap > 1e-12 * (radius_ + from.norm())) return std::nullopt;
  // The discriminant is a (r - m)(r + m), m the least distance of line and axis: no cancellation.
  const double inside = std::max(0.0, -gap * (gap + 2.0 * radius_));
  return (-half_b + std::sqrt(a * inside)) / a;
}

double Solid::clearance(double x, double y) const {
  if (plane_) return -1.0;
  const Eigen::Vector3d from = Eigen::Vector3d(x, y, 0.0) - point_;
  const Eigen::Vector3d common = direction_.cross(Eigen::Vector3d::UnitZ()).normalized();
  return std::abs(from.dot(common)) - radius_;
}

}  // namespace tubecut::joint
