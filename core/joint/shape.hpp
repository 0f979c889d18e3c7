#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/generator.hpp"

namespace tubecut::joint {

/// A rectangular hollow section as partner: an infinite prism by its axis. Lengths in mm.
struct BoxCutter {
  double width = 0.0;   // along `up` cross direction
  double height = 0.0;  // along `up`
  double corner = 0.0;  // outer corner radius, > 0, at most half the smaller side
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // made perpendicular to the direction
};

/// A cone as partner (a reducer): one nappe, without end. Lengths in mm.
struct ConeCutter {
  double radius = 0.0;    // > 0, at `point`
  Angle half_angle = {};  // between axis and surface, growing along the direction; +-80 deg
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
};

/// The frame of such a partner: rows across, across and along; and the target's z seen in it.
struct ShapeFrame {
  Eigen::Vector3d point;
  Eigen::Matrix3d rows;
  Eigen::Vector3d rise;

  /// The generator at z = 0; the generator runs along `rise` from there.
  [[nodiscard]] Eigen::Vector3d foot(const Generator& line) const {
    return rows *
           (Eigen::Vector3d(line.radius * line.cos_phi, line.radius * line.sin_phi, 0.0) - point);
  }
};

struct PreparedBox {
  ShapeFrame frame;
  double half_width, half_height, corner;
};
struct PreparedCone {
  ShapeFrame frame;
  double radius, slope;  // radius + slope * (along the axis)
};

/// Errors  out_of_range, zero_length, bad_reference_direction, parallel_axes: for a cone when the
///         target runs along its surface or inside its opening.
[[nodiscard]] Result<PreparedBox> prepare_shape(const BoxCutter& box, std::string_view member);
[[nodiscard]] Result<PreparedCone> prepare_shape(const ConeCutter& cone, std::string_view member);

/// Sine of the angle by which the target's axis leaves the partner's surface lines.
[[nodiscard]] double shape_sine(const PreparedBox& box);
[[nodiscard]] double shape_sine(const PreparedCone& cone);

/// Where a generator leaves the partner: as `upper_sheet`, `hit` and their continuations.
/// Accuracy  the point is on the surface within 1e-12 of its size and the target's radius.
/// Source    docs/theory/intersections-and-bevels.md, section 9.
[[nodiscard]] std::optional<double> shape_top(const PreparedBox& box, const Generator& line);
[[nodiscard]] std::optional<double> shape_top(const PreparedCone& cone, const Generator& line);
[[nodiscard]] Hit shape_hit(const PreparedBox& box, const Generator& line);
[[nodiscard]] Hit shape_hit(const PreparedCone& cone, const Generator& line);
/// z where the generator touches the silhouette, S = 0.
[[nodiscard]] double shape_touch(const PreparedBox& box, const Generator& line);
[[nodiscard]] double shape_touch(const PreparedCone& cone, const Generator& line);

/// By how much the generator passes outside the partner's left and right side, mm across; it is met
/// where neither is > 0. Both are linear in the generator's radius at one phi.
struct Sides {
  double left = 0.0, right = 0.0;
};
[[nodiscard]] Sides shape_sides(const PreparedBox& box, const Generator& line);
[[nodiscard]] Sides shape_sides(const PreparedCone& cone, const Generator& line);

}  // namespace tubecut::joint
