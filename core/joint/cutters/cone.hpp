#pragma once

#include "core/joint/cutters/axis_frame.hpp"
#include "core/joint/cutters/convex.hpp"
#include "core/joint/cutters/kind.hpp"

namespace tubecut::joint {

struct PreparedCone : PreparedConvex<PreparedCone> {
  AxisFrame frame;
  double radius, slope;  // radius + slope * (along the axis)

  [[nodiscard]] double sine() const;
  [[nodiscard]] std::optional<double> upper_sheet(const Generator& line) const;
  [[nodiscard]] double continued_sheet(const Generator& line) const;
  [[nodiscard]] Hit continued_hit(const Generator& line) const;
  [[nodiscard]] double silhouette_height(const Generator& line) const;
  [[nodiscard]] double size(double rho) const { return (std::abs(radius) + rho) / sine(); }
  [[nodiscard]] std::vector<Sheets> sheets(double rho) const;
  [[nodiscard]] std::vector<double> silhouettes(double rho) const;
  [[nodiscard]] Sides sides(const Generator& line) const;
};

struct ConeSolid : ConvexSolid<ConeSolid> {
  Eigen::Vector3d point, direction;  // of the axis; unit
  double radius;                     // at `point`
  double sine, cosine;               // of its half angle

  [[nodiscard]] double scale() const { return radius; }
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const;
};

/// A cone as partner (a reducer): one infinite nappe. Lengths in mm.
struct ConeCutter {
  static constexpr std::string_view kName = "cone";
  using Prepared = PreparedCone;
  using Solid = ConeSolid;

  double radius = 0.0;  // > 0, at `point`
  Angle half_angle =
      {};  // between axis and surface, > 0 if the cone widens along the direction; +-80 deg
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();

  /// Errors  also if the target runs along its surface or inside its opening.
  [[nodiscard]] Result<Prepared> prepare() const;
  [[nodiscard]] Solid solid() const;
  void grow(double by);
  void turn(const TurnAboutAxis& turn);
  [[nodiscard]] std::optional<Bearing> bearing() const { return bearing_of_axis(direction); }
};

}  // namespace tubecut::joint
