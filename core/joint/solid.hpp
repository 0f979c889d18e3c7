#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/joint/cutter.hpp"

namespace tubecut::joint {

/// A partner as a solid in 3D, in the target's frame: for proofs, by other formulas than the contour's.
class Solid {
 public:
  explicit Solid(const Cutter& cutter);

  /// Signed distance of a point to the surface, mm: negative inside the partner.
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;
  /// Outward unit normal at (or near) the surface.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& point) const;
  /// Largest z of the line parallel to z through (x, y) inside the partner; empty where it misses.
  [[nodiscard]] std::optional<double> top(double x, double y) const;
  /// Least distance of that line to the surface, negative where it passes inside.
  [[nodiscard]] double clearance(double x, double y) const;
  /// Radius of a tube, 0 of a plane: the scale of rounding.
  [[nodiscard]] double radius() const { return radius_; }

 private:
  Eigen::Vector3d point_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_ = Eigen::Vector3d::UnitZ();  // of the axis, or the plane's normal; unit
  double radius_ = 0.0;
  bool plane_ = false;
};

}  // namespace tubecut::joint
