#include "core/joint/placement.hpp"

#include <Eigen/Geometry>

#include "core/joint/cutters/kind.hpp"

namespace tubecut::joint {

Result<MemberFrame> member_frame(const Eigen::Vector3d& cut, const Eigen::Vector3d& far,
                                 const Eigen::Vector3d& reference) {
  const Eigen::Vector3d along = far - cut;
  const double length = along.norm();
  const double reference_length = reference.norm();
  if (!(length > 0.0)) return zero_length("far");
  if (!(reference_length > 0.0)) return zero_length("reference");
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
