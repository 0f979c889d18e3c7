#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/joint/cutter.hpp"

namespace tubecut::joint {

/// A partner as a solid in 3D, in the target's frame: for proofs, by other formulas than the
/// contour's.
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
  /// What its distance does along a straight line: a tube's or plane's follows a formula, a convex
  /// one's has one least value, a bent one's may have several.
  enum class Shape { plain, convex, bent };
  [[nodiscard]] Shape shape() const {
    return kind_ == Kind::elbow                        ? Shape::bent
           : kind_ == Kind::box || kind_ == Kind::cone ? Shape::convex
                                                       : Shape::plain;
  }
  /// Radius of a tube, 0 of a plane: the scale of rounding.
  [[nodiscard]] double radius() const { return radius_; }
  /// Where a straight way from `a` to `b` comes nearest to a plain solid (deepest, if it enters),
  /// 0..1 of the way. Exact.
  [[nodiscard]] double nearest_share(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  /// Bounds of the distance's second derivative along any unit direction, 1/mm. `most_bent`: from
  /// above, for a plain solid, where the distance is at least `from`. `most_hollow`: how far below
  /// zero it falls where the distance is at most `to`; 0 for a convex solid.
  [[nodiscard]] double most_bent(double from) const;
  [[nodiscard]] double most_hollow(double to) const;

 private:
  enum class Kind { tube, plane, box, cone, elbow };

  /// The point seen along `across_`, `up_` and the axis.
  [[nodiscard]] Eigen::Vector3d own(const Eigen::Vector3d& point) const;
  [[nodiscard]] double box_distance(const Eigen::Vector3d& point) const;
  [[nodiscard]] Eigen::Vector3d box_normal(const Eigen::Vector3d& point) const;
  /// The point of an elbow's centre line nearest to this one.
  [[nodiscard]] Eigen::Vector3d on_centre_line(const Eigen::Vector3d& point) const;
  /// Down an elbow's line from above, no further than the surface is away.
  [[nodiscard]] std::optional<double> elbow_top(double x, double y) const;
  /// Heights between which a line can come near an elbow.
  [[nodiscard]] Eigen::Vector2d elbow_range(double x, double y) const;
  /// Where the line is deepest in the partner: distance is convex along it.
  [[nodiscard]] double deepest(double x, double y) const;

  Eigen::Vector3d point_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_ =
      Eigen::Vector3d::UnitZ();  // of the axis, or the plane's normal; unit
  Eigen::Vector3d across_ = Eigen::Vector3d::UnitX(), up_ = Eigen::Vector3d::UnitY();  // of a box
  double radius_ = 0.0;
  double half_width_ = 0.0, half_height_ = 0.0, corner_ = 0.0;
  double sine_ = 0.0, cosine_ = 1.0;       // of a cone's half angle
  double bend_ = 0.0, bend_radius_ = 0.0;  // of an elbow; across_ points to where the bend begins
  Kind kind_ = Kind::tube;
};

}  // namespace tubecut::joint
