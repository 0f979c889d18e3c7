#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/joint/cutters/cutter.hpp"

namespace tubecut::joint {

/// A partner as a solid in 3D, in the target's frame: for proofs, by other formulas than the
/// contour's.
class Solid {
 public:
  using Kind = CutterKinds::Solid;

  explicit Solid(const Cutter& cutter);

  /// Signed distance of a point to the surface, mm: negative inside the partner.
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;
  /// Outward unit normal at (or near) the surface.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& point) const;
  /// Largest z of the line parallel to z through (x, y) inside the partner; empty where it misses.
  [[nodiscard]] std::optional<double> top(double x, double y) const;
  /// Least distance of that line to the surface, negative where it passes inside.
  [[nodiscard]] double clearance(double x, double y) const;
  /// Least signed distance of a straight cut from `a` to `b`.
  [[nodiscard]] double least_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  /// A length of its size, 0 of a plane: the scale of rounding.
  [[nodiscard]] double scale() const;

  /// For searches that go on by kind. All have `most_hollow`: a bound of how far below zero the
  /// second derivative of the distance along any unit direction falls where the distance is at most
  /// `to`, 1/mm; 0 of a convex one. A `PlainSolid` has `nearest_share`: where a straight way from
  /// `a` to `b` comes nearest to it (deepest, if it enters), 0..1, exact; and `most_bent`: a bound
  /// of that derivative from above where the distance is at least `from`.
  [[nodiscard]] const Kind& kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace tubecut::joint
