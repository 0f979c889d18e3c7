#pragma once

#include <Eigen/Core>

#include "core/base/error.hpp"
#include "core/joint/generator.hpp"
#include "core/joint/node/sheets.hpp"

/// For the kinds in this folder with a straight axis of any direction.
namespace tubecut::joint {

/// A partner's own frame: rows across, across and along; and the target's z in it.
struct AxisFrame {
  Eigen::Vector3d point;
  Eigen::Matrix3d rows;
  Eigen::Vector3d rise;

  /// Returns the point of the generator at z = 0; the generator runs along `rise` from there.
  [[nodiscard]] Eigen::Vector3d foot(const Generator& line) const {
    return rows *
           (Eigen::Vector3d(line.radius * line.cos_phi, line.radius * line.sin_phi, 0.0) - point);
  }
  /// Returns a component of the foot over phi.
  [[nodiscard]] Trig<1> component(const Eigen::Vector3d& along, double rho) const;
};

/// The frame with its origin where the axis is nearest to the target's, because far points lose
/// digits.
struct NearestFrame {
  AxisFrame frame;
  double moved = 0.0;  // along the axis
};
/// Errors  zero_length (axis, up), bad_reference_direction (up), parallel_axes.
[[nodiscard]] Result<NearestFrame> nearest_frame(const Eigen::Vector3d& point,
                                                 const Eigen::Vector3d& direction,
                                                 const Eigen::Vector3d& up);

/// The generator in the plane across the partner's axis: components along and perpendicular to its
/// own direction there.
struct Crossing {
  double across;  // length of the rise across the axis
  Trig<1> along, beside, axial;
};
[[nodiscard]] Crossing crossing(const AxisFrame& frame, double rho);
[[nodiscard]] Trig<1> constant(double value);

}  // namespace tubecut::joint
