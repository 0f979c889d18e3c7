#pragma once

#include <Eigen/Core>

#include "core/base/error.hpp"
#include "core/joint/cutters/tube.hpp"

namespace tubecut::joint {

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

/// Returns the frame with z from `cut` into the kept member (towards `far`) and phi = 0 on the side
/// of `reference`.
/// Errors    zero_length (cut = far, reference = 0), bad_reference_direction (parallel to z within
///           kParallel).
/// Source    docs/theory/intersections-and-bevels.md, section 1.1.
[[nodiscard]] Result<MemberFrame> member_frame(const Eigen::Vector3d& cut,
                                               const Eigen::Vector3d& far,
                                               const Eigen::Vector3d& reference);

/// Returns the reference that gives the chord clocking 0, source 000's phase zero.
[[nodiscard]] Eigen::Vector3d chord_reference(const Eigen::Vector3d& member_direction,
                                              const Eigen::Vector3d& chord_direction);

}  // namespace tubecut::joint
