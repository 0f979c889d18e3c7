#pragma once

#include "core/joint/cutters/kind.hpp"

namespace tubecut::joint {

struct PreparedTube {
  double radius, offset, height;
  double cos_inclination, sin_inclination;
  double cos_clocking, sin_clocking;

  [[nodiscard]] double sine() const { return sin_inclination; }
  [[nodiscard]] std::optional<double> upper_sheet(const Generator& line) const;
  [[nodiscard]] double continued_sheet(const Generator& line) const;
  [[nodiscard]] Hit continued_hit(const Generator& line) const;
  [[nodiscard]] double silhouette_height(const Generator& line) const;
  [[nodiscard]] double silhouette_slope(const Generator& line) const;
  [[nodiscard]] Hit hit_at_corner(const Generator& line, Side side) const;
  [[nodiscard]] Eigen::Vector3d published_normal(const Generator& line) const;
  [[nodiscard]] Met met(double rho) const;
  [[nodiscard]] double size(double rho) const { return (radius + rho) / sin_inclination; }
  [[nodiscard]] std::vector<Sheets> sheets(double rho) const;
  [[nodiscard]] std::vector<double> silhouettes(double rho) const;
  [[nodiscard]] std::vector<double> kinks(double rho) const;
  [[nodiscard]] Heights heights_near(const Generator& /*line*/, double /*off*/) const { return {}; }
  [[nodiscard]] double steepest(const Wall& wall, const Generator& inner, double z_root) const;
  [[nodiscard]] double support(const Wall& wall, const Generator& inner, double slope) const;
};

/// Computes distances by cross product, heights by the quadratic of line and cylinder.
struct TubeSolid {
  Eigen::Vector3d point, direction;  // of the axis; unit
  double radius;

  [[nodiscard]] double scale() const { return radius; }
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& point) const;
  [[nodiscard]] std::optional<double> top(double x, double y) const;
  [[nodiscard]] double clearance(double x, double y) const;
  [[nodiscard]] double least_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] double nearest_share(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] double most_bent(double from) const;
  [[nodiscard]] double most_hollow(double /*to*/) const { return 0.0; }
};

/// A round partner of the target, an infinite cylinder. Lengths in mm.
/// Frame: z along the target axis from the cut end into the kept member, phi from x towards y.
struct TubeCutter {
  static constexpr std::string_view kName = "tube";
  using Prepared = PreparedTube;
  using Solid = TubeSolid;

  double radius = 0.0;                 // > 0
  Angle inclination = Angle::deg(90);  // alpha, between the axes, open interval (0, 180) deg
  Angle clocking = {};                 // beta, of the common perpendicular
  double offset = 0.0;                 // s, signed distance of the axes
  double height = 0.0;                 // h, where the common perpendicular meets the target axis

  [[nodiscard]] Result<Prepared> prepare() const;
  [[nodiscard]] Solid solid() const;
  void grow(double by) { radius += by; }
  void turn(const TurnAboutAxis& turn) { clocking = clocking + turn.angle; }
  [[nodiscard]] std::optional<Bearing> bearing() const;
};

/// A straight line; direction of any length > 0. Lengths in mm.
struct AxisLine {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
};

/// A tube by its axis line in the target's frame, and the position of the line's point on it.
struct Placement {
  TubeCutter tube;
  double point_axial = 0.0;  // w of AxisLine::point, along the direction, from the perpendicular
};

/// Computes the four numbers of a tube from its axis. Clocking in [0, 360) deg; inclination in (0,
/// 180).
///
/// Errors    zero_length, parallel_axes (limit kParallel), both of `direction`.
/// Accuracy  line -> numbers -> line passes the point within 1e-13 of |point| + |offset| +
///           |height|.
/// Source    docs/theory/intersections-and-bevels.md, section 1.1.
[[nodiscard]] Result<Placement> place(const AxisLine& axis, double radius);

/// Returns the axis in the target's frame: the foot of the common perpendicular and the unit
/// direction.
[[nodiscard]] AxisLine axis_of(const TubeCutter& tube);

/// A tube partner given by its axis line in the target's frame.
struct AxisTube {
  static constexpr auto kName = TubeCutter::kName;
  double radius = 0.0;
  AxisLine axis;

  /// Errors  as `place`, under `axis`.
  [[nodiscard]] Result<TubeCutter> tube() const;
  void grow(double by) { radius += by; }
  void turn(const TurnAboutAxis& turn);
  [[nodiscard]] std::optional<Bearing> bearing() const { return bearing_of_axis(axis.direction); }
};

}  // namespace tubecut::joint
