#pragma once

#include <Eigen/Core>
#include <string_view>

#include "core/base/error.hpp"
#include "core/joint/cutter.hpp"

namespace tubecut::joint {

/// A straight line; direction of any length > 0. Lengths in mm.
struct AxisLine {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
};

/// A tube by its axis line in the target's frame, and where the line's point lies on it.
struct Placement {
  TubeCutter tube;
  double point_axial = 0.0;  // w of AxisLine::point, along the direction, from the perpendicular
};

/// The four numbers of a tube from its axis. Clocking in [0, 360) deg; inclination in (0, 180).
/// `member` names the tube in errors.
///
/// Errors    zero_length, parallel_axes (limit kParallel).
/// Accuracy  line -> numbers -> line passes the point within 1e-13 of |point| + |offset| +
/// |height|. Source    docs/theory/intersections-and-bevels.md, section 1.1.
[[nodiscard]] Result<Placement> place(const AxisLine& axis, double radius, std::string_view member);

/// The axis in the target's frame: the foot of the common perpendicular and the unit direction.
[[nodiscard]] AxisLine axis_of(const TubeCutter& tube);

/// The frame of a member's cut end: origin at the end, rows x, y, z of the target's frame.
struct MemberFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();

  [[nodiscard]] Eigen::Vector3d local(const Eigen::Vector3d& world) const {
    return rows * (world - origin);
  }
  [[nodiscard]] AxisLine local(const AxisLine& world) const {
    return {local(world.point), rows * world.direction};
  }
};

/// z from `cut` into the kept member (towards `far`), phi = 0 on the side of `reference`.
/// Errors    zero_length (cut = far, reference = 0), bad_reference_direction (parallel to z within
///           kParallel).
/// Source    docs/theory/intersections-and-bevels.md, section 1.1.
[[nodiscard]] Result<MemberFrame> member_frame(const Eigen::Vector3d& cut,
                                               const Eigen::Vector3d& far,
                                               const Eigen::Vector3d& reference);

/// The reference with which the chord gets clocking 0, source 000's phase zero.
[[nodiscard]] Eigen::Vector3d chord_reference(const Eigen::Vector3d& member_direction,
                                              const Eigen::Vector3d& chord_direction);

}  // namespace tubecut::joint
