#include "core/joint/cutters/plane.hpp"

#include <algorithm>

#include "core/base/elementary.hpp"
#include "core/joint/node/sheets.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::joint {

using Eigen::Vector3d;

Result<PreparedPlane> PlaneCutter::prepare() const {
  const double length = normal.norm();
  if (!(length > 0.0)) return zero_length("normal");
  Vector3d n = normal / length;
  if (n.z() < 0.0) n = -n;
  if (!(n.z() >= kParallel))
    return parallel_axes("normal", n.z(), "the angle must be greater than the limit");
  return PreparedPlane{point.dot(n) / n.z(), -n.x() / n.z(), -n.y() / n.z(), n};
}

void PlaneCutter::grow(double by) {
  const double up = normal.z() < 0.0 ? -1.0 : 1.0;
  point += up * by * normal.normalized();
}

void PlaneCutter::turn(const TurnAboutAxis& turn) {
  point = turn.by * point;
  normal = turn.by * normal;
}

std::optional<Bearing> PlaneCutter::bearing() const {
  Vector3d n = normal / normal.norm();
  if (n.z() < 0.0) n = -n;
  if (elementary::hypot(n.x(), n.y()) <= kSquare) return std::nullopt;
  const double lean = math::whole_turn(elementary::atan2(-n.y(), -n.x()));
  return Bearing{math::whole_turn(lean + 0.5 * kPi), lean};
}

Hit PreparedPlane::continued_hit(const Generator& g) const {
  const auto& n = normal;
  return {.z = continued_sheet(g),
          .normal = {n.x() * g.cos_phi + n.y() * g.sin_phi, n.y() * g.cos_phi - n.x() * g.sin_phi,
                     n.z()},
          .z_dphi = g.radius * (slope_y * g.cos_phi - slope_x * g.sin_phi),
          .axial = 0.0};
}

std::vector<Sheets> PreparedPlane::sheets(double rho) const {
  return {
      {Trig<1>::first_order(height, rho * slope_x, rho * slope_y), Trig<2>{}, size(rho), false}};
}

double PreparedPlane::steepest(const Wall& wall, const Generator& g, double z_root) const {
  const double slope = slope_x * g.cos_phi + slope_y * g.sin_phi;
  const double gap = z_root - (height + wall.inner * slope);
  return slope - std::max(0.0, gap) / (wall.outer - wall.inner);
}

double PreparedPlane::support(const Wall& wall, const Generator& g, double slope) const {
  const double own = slope_x * g.cos_phi + slope_y * g.sin_phi;
  return height + wall.inner * own + std::max(0.0, (wall.outer - wall.inner) * (own - slope));
}

PlaneSolid PlaneCutter::solid() const {
  Vector3d up = normal.normalized();
  if (up.z() < 0.0) up = -up;
  return {point, up};
}

std::optional<double> PlaneSolid::top(double x, double y) const {
  return -(Vector3d(x, y, 0.0) - point).dot(upwards) / upwards.z();
}

double PlaneSolid::least_distance(const Vector3d& a, const Vector3d& b) const {
  return std::min({distance(a), distance(0.5 * (a + b)), distance(b)});
}

}  // namespace tubecut::joint
