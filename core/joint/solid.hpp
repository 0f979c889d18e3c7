#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/joint/cutters/cutter.hpp"

namespace tubecut::joint {

/// A partner as a solid in 3D, in the target's frame: for verification by formulas independent of
/// the contour's.
class Solid {
 public:
  using Kind = CutterKinds::Solid;

  explicit Solid(const Cutter& cutter);

  /// Computes the signed distance of a point to the surface, mm: negative inside the partner.
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;
  /// Computes the outward unit normal at (or near) the surface.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& point) const;
  /// Computes the largest z of the line parallel to z through (x, y) inside the partner; empty when
  /// it misses.
  [[nodiscard]] std::optional<double> top(double x, double y) const;
  /// Computes the smallest distance of that line to the surface, negative if it passes inside.
  [[nodiscard]] double clearance(double x, double y) const;
  /// Computes the smallest signed distance of a straight cut from `a` to `b`.
  [[nodiscard]] double least_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  /// Returns a length of its size, 0 for a plane: the scale of rounding.
  [[nodiscard]] double scale() const;

  /// Returns the kind, for searches that depend on it. All have `most_hollow`: a bound of the
  /// magnitude of a negative second derivative of the distance along any unit direction, where the
  /// distance is at most `to`, 1/mm; 0 if convex. A `PlainSolid` has `nearest_share`: the fraction
  /// 0..1 of a straight path from `a` to `b` where it is nearest (deepest, if it enters), exact;
  /// and `most_bent`: an upper bound of that derivative where the distance is at least `from`.
  [[nodiscard]] const Kind& kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace tubecut::joint
