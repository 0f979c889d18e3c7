#pragma once

#include <Eigen/Core>

#include "core/base/error.hpp"
#include "core/joint/generator.hpp"
#include "core/joint/node/sheets.hpp"

/// For the kinds of this folder that stand on a straight axis of any direction.
namespace tubecut::joint {

/// A partner's own frame: rows across, across and along; and the target's z seen in it.
struct AxisFrame {
  Eigen::Vector3d point;
  Eigen::Matrix3d rows;
  Eigen::Vector3d rise;

  /// The generator at z = 0; the generator runs along `rise` from there.
  [[nodiscard]] Eigen::Vector3d foot(const Generator& line) const {
    return rows *
           (Eigen::Vector3d(line.radius * line.cos_phi, line.radius * line.sin_phi, 0.0) - point);
  }
  /// A component of the foot over phi.
  [[nodiscard]] Trig<1> component(const Eigen::Vector3d& along, double rho) const;
};

/// The frame with its origin where the axis is nearest to the target's: far points lose digits.
struct NearestFrame {
  AxisFrame frame;
  double moved = 0.0;  // along the axis
};
/// Errors  zero_length (axis, up), bad_reference_direction (up), parallel_axes.
[[nodiscard]] Result<NearestFrame> nearest_frame(const Eigen::Vector3d& point,
                                                 const Eigen::Vector3d& direction,
                                                 const Eigen::Vector3d& up);

/// The generator across the partner's axis, seen along and beside its own direction there.
struct Crossing {
  double across;  // length of the rise across the axis
  Trig<1> along, beside, axial;
};
[[nodiscard]] Crossing crossing(const AxisFrame& frame, double rho);
[[nodiscard]] Trig<1> constant(double value);

}  // namespace tubecut::joint
