#pragma once

#include "core/joint/cutters/axis_frame.hpp"
#include "core/joint/cutters/convex.hpp"
#include "core/joint/cutters/kind.hpp"

namespace tubecut::joint {

struct PreparedRectangularTube : PreparedConvex<PreparedRectangularTube> {
  AxisFrame frame;
  double half_width, half_height, corner;

  [[nodiscard]] double sine() const;
  [[nodiscard]] std::optional<double> upper_sheet(const Generator& line) const;
  [[nodiscard]] double continued_sheet(const Generator& line) const;
  [[nodiscard]] Hit continued_hit(const Generator& line) const;
  [[nodiscard]] double silhouette_height(const Generator& line) const;
  [[nodiscard]] double size(double rho) const;
  /// Returns its faces and the cylinders of its corners, each continued without end.
  [[nodiscard]] std::vector<Sheets> sheets(double rho) const;
  [[nodiscard]] std::vector<double> silhouettes(double rho) const;
  [[nodiscard]] Sides sides(const Generator& line) const;
};

struct RectangularTubeSolid : ConvexSolid<RectangularTubeSolid> {
  Eigen::Vector3d point, direction;  // of the axis; unit
  Eigen::Vector3d across, up;        // unit
  double half_width, half_height, corner;

  [[nodiscard]] double scale() const { return half_width + half_height; }
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const;
};

/// A rectangular hollow section as partner: an infinite prism along its axis. Lengths in mm.
struct RectangularTubeCutter {
  static constexpr std::string_view kName = "rectangular_tube";
  using Prepared = PreparedRectangularTube;
  using Solid = RectangularTubeSolid;

  double width = 0.0;   // along `up` cross direction
  double height = 0.0;  // along `up`
  double corner = 0.0;  // outer corner radius, > 0, at most half the smaller side
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // made perpendicular to the direction

  [[nodiscard]] Result<Prepared> prepare() const;
  [[nodiscard]] Solid solid() const;
  void grow(double by);
  void turn(const TurnAboutAxis& turn);
  /// Turns sides that are along z but for this angle, rad, along it, about `point`. Rounding turns
  /// them so, and a generator that grazes such a side leaves it anywhere over its width.
  void straighten(double within);
  [[nodiscard]] std::optional<Bearing> bearing() const { return bearing_of_axis(direction); }
};

}  // namespace tubecut::joint
