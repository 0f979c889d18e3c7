#pragma once

#include "core/joint/cutters/kind.hpp"

namespace tubecut::joint {

/// How a generator passes an elbow from above: its highest point of the surface, or, if it misses,
/// the point that is nearest to the elbow.
struct ElbowPass {
  bool met = false;
  double z = 0.0;
  double clearance = 0.0;  // mm; of a generator that misses, exact
};

/// In the frame of the bend: origin at its centre, x to its beginning, y along the direction there,
/// z across. `end` is its end on the unit circle.
struct PreparedElbow {
  Eigen::Vector3d center;
  Eigen::Matrix3d rows;
  Eigen::Vector3d rise;  // the target's z
  double radius, bend_radius;
  Eigen::Vector2d end;

  /// Follows the distance from the centre line downwards by steps that cannot pass the surface: by
  /// the distance itself, or by a bound of second order, which converges quadratically.
  /// Accuracy  the point is within 1e-12 (radius + bend radius) of the surface.
  /// Cost      about ten distances; a grazing generator up to a hundred. One that misses: also the
  ///           zeros of a trigonometric polynomial of order 2.
  /// Source    docs/theory/intersections-and-bevels.md, section 9.
  [[nodiscard]] ElbowPass pass(const Generator& line) const;

  [[nodiscard]] double sine() const;
  [[nodiscard]] std::optional<double> upper_sheet(const Generator& line) const;
  [[nodiscard]] double continued_sheet(const Generator& line) const { return pass(line).z; }
  [[nodiscard]] Hit continued_hit(const Generator& line) const;
  [[nodiscard]] double silhouette_height(const Generator& line) const { return pass(line).z; }
  [[nodiscard]] double silhouette_slope(const Generator& /*line*/) const { return 0.0; }
  [[nodiscard]] Hit hit_at_corner(const Generator& line, Side /*side*/) const {
    return continued_hit(line);
  }
  [[nodiscard]] Eigen::Vector3d published_normal(const Generator& line) const {
    return continued_hit(line).normal;
  }
  [[nodiscard]] Met met(double rho) const;
  [[nodiscard]] double size(double rho) const { return (radius + bend_radius + rho) / sine(); }
  /// Returns empty, because its surface is of the fourth degree; its events are bracketed instead.
  [[nodiscard]] std::vector<Sheets> sheets(double rho) const;
  /// Finds the sign changes of the clearance, scanned at 720 phases, and those next to an extremum
  /// between them. If the clearance has several extrema within one degree, some may be missed.
  [[nodiscard]] std::vector<double> silhouettes(double rho) const;
  [[nodiscard]] std::vector<double> kinks(double /*rho*/) const { return {}; }
  [[nodiscard]] Heights heights_near(const Generator& line, double off) const;
  [[nodiscard]] double steepest(const Wall& wall, const Generator& inner, double z_root) const;
  [[nodiscard]] double support(const Wall& wall, const Generator& inner, double slope) const;
};

struct ElbowSolid {
  Eigen::Vector3d point;  // the bend's centre
  Eigen::Vector3d direction,
      across;  // unit: of the incoming leg, and to the beginning of the bend
  double radius, bend_radius;
  double bend;  // rad

  [[nodiscard]] double scale() const { return radius; }
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const;
  /// Steps down the line from above by the distance to the surface.
  [[nodiscard]] std::optional<double> top(double x, double y) const;
  [[nodiscard]] double clearance(double x, double y) const;
  [[nodiscard]] double least_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] double most_hollow(double to) const;

 private:
  /// Returns the point of the centre line nearest to this one.
  [[nodiscard]] Eigen::Vector3d on_centre_line(const Eigen::Vector3d& p) const;
  /// Returns the heights between which a line can come near.
  [[nodiscard]] Eigen::Vector2d range(double x, double y) const;
};

/// A bent tube as partner: an arc of a torus with its two straight, infinite legs. Lengths in mm.
/// The bend begins at `point` of the centre line, runs along `direction` there and turns towards
/// `inwards`.
struct ElbowCutter {
  static constexpr std::string_view kName = "elbow";
  using Prepared = PreparedElbow;
  using Solid = ElbowSolid;

  double radius = 0.0;          // > 0, of the tube
  double bend_radius = 0.0;     // > radius, of the centre line
  Angle bend = Angle::deg(90);  // (0, 180] deg
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  Eigen::Vector3d inwards = Eigen::Vector3d::UnitZ();  // made perpendicular to the direction

  /// Errors  also if the target runs along one of the legs.
  [[nodiscard]] Result<Prepared> prepare() const;
  [[nodiscard]] Solid solid() const;
  void grow(double by) { radius += by; }
  void turn(const TurnAboutAxis& turn);
  [[nodiscard]] std::optional<Bearing> bearing() const { return bearing_of_axis(direction); }
};

}  // namespace tubecut::joint
