#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/generator.hpp"

namespace tubecut::joint {

/// A bent tube as partner: an arc of a torus with its two straight legs, which have no end.
/// Lengths in mm. The bend begins at `point` of the centre line, runs along `direction` there and
/// turns towards `inwards`.
struct ElbowCutter {
  double radius = 0.0;          // > 0, of the tube
  double bend_radius = 0.0;     // > radius, of the centre line
  Angle bend = Angle::deg(90);  // (0, 180] deg
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  Eigen::Vector3d inwards = Eigen::Vector3d::UnitZ();  // made perpendicular to the direction
};

/// In the frame of the bend: origin at its centre, x to where it begins, y along the direction
/// there, z across. `end` is where it ends on the unit circle.
struct PreparedElbow {
  Eigen::Vector3d center;
  Eigen::Matrix3d rows;
  Eigen::Vector3d rise;  // the target's z
  double radius, bend_radius;
  Eigen::Vector2d end;
};

/// Errors  out_of_range, zero_length, bad_reference_direction; parallel_axes when the target runs
///         along one of the legs.
[[nodiscard]] Result<PreparedElbow> prepare_elbow(const ElbowCutter& elbow,
                                                  std::string_view member);

/// Sine of the smaller angle between the target's axis and a leg.
[[nodiscard]] double elbow_sine(const PreparedElbow& elbow);

/// How a generator passes the elbow from above: its highest point of the surface, or, where it
/// misses, the place it comes nearest to.
struct ElbowPass {
  bool met = false;
  double z = 0.0;
  double clearance = 0.0;  // <= 0 where met
};

/// The distance from the centre line is followed downwards by steps that cannot pass the surface:
/// by the distance itself, or by a bound of second order, which converges quadratically.
/// Accuracy  the point is within 1e-12 (radius + bend radius) of the surface.
/// Cost      about ten distances; a grazing generator up to a hundred.
/// Source    docs/theory/intersections-and-bevels.md, section 9.
[[nodiscard]] ElbowPass elbow_pass(const PreparedElbow& elbow, const Generator& line);
[[nodiscard]] Hit elbow_hit(const PreparedElbow& elbow, const Generator& line);

// The names under which boxes and cones answer too.
[[nodiscard]] inline double shape_sine(const PreparedElbow& elbow) { return elbow_sine(elbow); }
[[nodiscard]] inline std::optional<double> shape_top(const PreparedElbow& elbow,
                                                     const Generator& line) {
  const auto pass = elbow_pass(elbow, line);
  return pass.met ? std::optional(pass.z) : std::nullopt;
}
[[nodiscard]] inline Hit shape_hit(const PreparedElbow& elbow, const Generator& line) {
  return elbow_hit(elbow, line);
}
[[nodiscard]] inline double shape_touch(const PreparedElbow& elbow, const Generator& line) {
  return elbow_pass(elbow, line).z;
}

}  // namespace tubecut::joint
