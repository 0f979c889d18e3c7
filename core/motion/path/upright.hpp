#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/base/angle.hpp"
#include "core/motion/path/cut_path.hpp"
#include "core/section/section.hpp"

namespace tubecut::motion {

/// Returns the radius of a circle as long as the section's outside, mm. A path around a section has
/// phi = girth / this radius, so one revolution is once around it, and its developed surface is
/// that of a round tube of this radius.
[[nodiscard]] double equal_radius(const section::Section& section);

/// Returns the thickest wall along an inward normal, mm: that of a corner's middle if the corners
/// are not concentric.
[[nodiscard]] double thickest(const section::Section& section);

/// Returns the angle of the outward normal at girth `s`, rad, with whole revolutions: from x
/// towards y.
[[nodiscard]] double normal_at(const section::Curve& outside, double s);

/// Returns the same at the first point of a path around a section.
[[nodiscard]] double normal_of_first(const CutPath& path);

/// Returns a path without points around a section, its wall the thickest.
[[nodiscard]] CutPath around(const section::Section& section);

/// How a machine that keeps the normal of a section up follows its outside.
///
/// The angle of the normal jumps in speed at each seam. Its mean, weighted by a triangle of half
/// width l along the outside, has a bounded third derivative; it leans from the normal by at most
/// l / (6 r), at the seams of a corner of radius r. Only the angle is blended, so the tip stays on
/// the outside.
///
/// Source  docs/theory/sections.md, section 7.
class Upright {
 public:
  /// `lean`: the largest angle between the torch's plane and the normal, > 0. `still`: the angle of
  /// the plane if the tube is still.
  Upright(const section::Section& section, Angle lean, std::optional<double> still = {});

  /// Returns l, mm.
  [[nodiscard]] double half_width() const { return half_width_; }
  /// Returns the angle of the torch's plane at girth `s`, rad, with whole revolutions: from x
  /// towards y.
  [[nodiscard]] double angle(double s) const;
  /// Returns the place of the outside, mm.
  [[nodiscard]] Eigen::Vector2d point(double s) const { return curve_.at(s).point; }
  /// Returns the girths strictly between two, ascending, at which the curvature jumps or a blend
  /// begins or ends.
  [[nodiscard]] std::vector<double> breaks(double from, double to) const;
  /// Returns the girths strictly between two, ascending, at which a polyline needs points: on arcs,
  /// and as far next to them as the angle is blended.
  [[nodiscard]] std::vector<double> places(double from, double to) const;

 private:
  section::Curve curve_;
  double half_width_;
  double step_;  // mm between points
  std::optional<double> still_;
  struct Seam {
    double s, jump;  // of the curvature, 1/mm
  };
  std::vector<Seam> seams_ = {};
};

/// Returns the distance of a point from the outside, mm: positive beyond it. Independent of
/// `section::Curve`: the section is a rectangle that a disc of the corner's radius is moved over.
[[nodiscard]] double beyond_outside(const section::Section& section, const Eigen::Vector2d& point);
/// Returns the girth of the place of the outside nearest to the point, mm.
[[nodiscard]] double girth_at(const section::Section& section, const Eigen::Vector2d& point);
/// Returns the direction of the outward normal at the place nearest to the point, rad, -pi..pi, by
/// the same construction.
[[nodiscard]] double normal_towards(const section::Section& section, const Eigen::Vector2d& point);

}  // namespace tubecut::motion
