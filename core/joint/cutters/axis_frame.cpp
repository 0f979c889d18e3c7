#include "core/joint/cutters/axis_frame.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/joint/cutters/kind.hpp"

namespace tubecut::joint {

using Eigen::Vector3d;

Trig<1> AxisFrame::component(const Vector3d& along, double rho) const {
  const Vector3d global = rows.transpose() * along;
  return Trig<1>::first_order(-global.dot(point), rho * global.x(), rho * global.y());
}

Result<NearestFrame> nearest_frame(const Vector3d& point, const Vector3d& direction,
                                   const Vector3d& up) {
  const double length = direction.norm();
  if (!(length > 0.0)) return zero_length("axis");
  const Vector3d d = direction / length;
  const Vector3d across = up - up.dot(d) * d;
  const double size = across.norm();
  if (!(up.norm() > 0.0)) return zero_length("up");
  if (!(size >= kParallel * up.norm()))
    return fail({.code = ErrorCode::bad_reference_direction, .member = "up"});
  const double flat = d.x() * d.x() + d.y() * d.y();
  if (!(flat >= kParallel * kParallel))
    return parallel_axes(
        "", std::sqrt(flat),
        "its axis runs along the member's and cuts no end of it; the angle must be "
        "greater than the limit");
  NearestFrame out;
  out.moved = -(point.x() * d.x() + point.y() * d.y()) / flat;
  out.frame.point = point + out.moved * d;
  out.frame.rows.row(1) = across / size;
  out.frame.rows.row(0) = (across / size).cross(d);
  out.frame.rows.row(2) = d;
  out.frame.rise = out.frame.rows.col(2);
  return out;
}

Trig<1> constant(double value) { return Trig<1>::first_order(value, 0.0, 0.0); }

Crossing crossing(const AxisFrame& frame, double rho) {
  const auto& w = frame.rise;
  const double wp = std::sqrt(w.x() * w.x() + w.y() * w.y());
  return {wp, frame.component({w.x() / wp, w.y() / wp, 0.0}, rho),
          frame.component({w.y() / wp, -w.x() / wp, 0.0}, rho),
          frame.component({0.0, 0.0, 1.0}, rho)};
}

}  // namespace tubecut::joint
