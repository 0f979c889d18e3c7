#include "core/joint/placement.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "core/base/elementary.hpp"

namespace tubecut::joint {
namespace {

Angle whole_turn(double phi) { return Angle::rad(phi < 0.0 ? phi + kTwoPi : phi); }

}  // namespace

Result<Placement> place(const AxisLine& axis, double radius, std::string_view member) {
  const double length = axis.direction.norm();
  if (!(length > 0.0))
    return fail({.code = ErrorCode::zero_length,
                 .member = std::string(member) + "/direction",
                 .got = 0.0,
                 .limit = 0.0,
                 .hint = "the vector's length must be greater than the limit"});
  const Eigen::Vector3d d = axis.direction / length;
  const double sin_a = elementary::hypot(d.x(), d.y());
  const double inclination = elementary::atan2(sin_a, d.z());
  if (!(sin_a >= kParallel))
    return fail({.code = ErrorCode::parallel_axes,
                 .member = std::string(member) + "/direction",
                 .got = std::min(inclination, kPi - inclination) * kDegPerRad,
                 .limit = kParallel * kDegPerRad,
                 .unit = "deg",
                 .hint = "the angle must be greater than the limit"});
  const double cos_b = -d.y() / sin_a;
  const double sin_b = d.x() / sin_a;
  const auto& q = axis.point;
  const double to_foot = (q.y() * cos_b - q.x() * sin_b) / sin_a;
  return Placement{.tube = {.radius = radius,
                            .inclination = Angle::rad(inclination),
                            .clocking = whole_turn(elementary::atan2(sin_b, cos_b)),
                            .offset = -(q.x() * cos_b + q.y() * sin_b),
                            .height = q.z() + to_foot * d.z()},
                   .point_axial = -to_foot};
}

AxisLine axis_of(const TubeCutter& tube) {
  const auto a = elementary::sincos(tube.inclination.rad());
  const auto b = elementary::sincos(tube.clocking.rad());
  return {{-tube.offset * b.cos, -tube.offset * b.sin, tube.height},
          {a.sin * b.sin, -a.sin * b.cos, a.cos}};
}

Result<MemberFrame> member_frame(const Eigen::Vector3d& cut, const Eigen::Vector3d& far,
                                 const Eigen::Vector3d& reference) {
  const Eigen::Vector3d along = far - cut;
  const double length = along.norm();
  const double reference_length = reference.norm();
  if (!(length > 0.0)) return fail({.code = ErrorCode::zero_length, .member = "far"});
  if (!(reference_length > 0.0))
    return fail({.code = ErrorCode::zero_length, .member = "reference"});
  const Eigen::Vector3d z = along / length;
  const Eigen::Vector3d g = reference / reference_length;
  const Eigen::Vector3d across = g - g.dot(z) * z;
  const double sine = across.norm();
  if (!(sine >= kParallel))
    return fail({.code = ErrorCode::bad_reference_direction,
                 .member = "reference",
                 .got = sine * kDegPerRad,
                 .limit = kParallel * kDegPerRad,
                 .unit = "deg"});
  MemberFrame frame{.origin = cut, .rows = {}};
  const Eigen::Vector3d x = across / sine;
  frame.rows.row(0) = x;
  frame.rows.row(1) = z.cross(x);
  frame.rows.row(2) = z;
  return frame;
}

Eigen::Vector3d chord_reference(const Eigen::Vector3d& member_direction,
                                const Eigen::Vector3d& chord_direction) {
  return member_direction.cross(chord_direction);
}

}  // namespace tubecut::joint
