#pragma once

#include <cmath>

#include "core/joint/cutters/kind.hpp"

namespace tubecut::joint {

struct PreparedPlane {
  double height;            // z on the target axis
  double slope_x, slope_y;  // z = height + slope_x x + slope_y y
  Eigen::Vector3d normal;   // unit, z > 0, in the target frame

  [[nodiscard]] double sine() const { return normal.z(); }
  [[nodiscard]] double continued_sheet(const Generator& line) const {
    return height + line.radius * (slope_x * line.cos_phi + slope_y * line.sin_phi);
  }
  [[nodiscard]] std::optional<double> upper_sheet(const Generator& line) const {
    return continued_sheet(line);
  }
  [[nodiscard]] double silhouette_height(const Generator& line) const {
    return continued_sheet(line);
  }
  [[nodiscard]] double silhouette_slope(const Generator& /*line*/) const { return 0.0; }
  [[nodiscard]] Hit continued_hit(const Generator& line) const;
  [[nodiscard]] Hit hit_at_corner(const Generator& line, Side /*side*/) const {
    return continued_hit(line);
  }
  [[nodiscard]] Eigen::Vector3d published_normal(const Generator& line) const {
    return continued_hit(line).normal;
  }
  [[nodiscard]] Met met(double /*rho*/) const { return Met::always; }
  [[nodiscard]] double size(double rho) const {
    return rho + std::abs(rho * slope_x) + std::abs(rho * slope_y);
  }
  [[nodiscard]] std::vector<Sheets> sheets(double rho) const;
  [[nodiscard]] std::vector<double> silhouettes(double /*rho*/) const { return {}; }
  [[nodiscard]] std::vector<double> kinks(double /*rho*/) const { return {}; }
  [[nodiscard]] Heights heights_near(const Generator& /*line*/, double /*off*/) const { return {}; }
  [[nodiscard]] double steepest(const Wall& wall, const Generator& inner, double z_root) const;
  [[nodiscard]] double support(const Wall& wall, const Generator& inner, double slope) const;
};

struct PlaneSolid {
  Eigen::Vector3d point, upwards;  // its normal; unit, z > 0

  [[nodiscard]] double scale() const { return 0.0; }
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const { return (p - point).dot(upwards); }
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& /*p*/) const { return upwards; }
  [[nodiscard]] std::optional<double> top(double x, double y) const;
  [[nodiscard]] double clearance(double /*x*/, double /*y*/) const { return -1.0; }
  [[nodiscard]] double least_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] double nearest_share(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return (b - a).dot(upwards) < 0.0 ? 1.0 : 0.0;
  }
  [[nodiscard]] double most_bent(double /*from*/) const { return 0.0; }
  [[nodiscard]] double most_hollow(double /*to*/) const { return 0.0; }
};

/// A plane as partner: the target is cut along it, and the material on the side of its normal is
/// kept.
struct PlaneCutter {
  static constexpr std::string_view kName = "plane";
  using Prepared = PreparedPlane;
  using Solid = PlaneSolid;

  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // any length > 0; flipped if z < 0

  [[nodiscard]] Result<Prepared> prepare() const;
  [[nodiscard]] Solid solid() const;
  void grow(double by);
  void turn(const TurnAboutAxis& turn);
  [[nodiscard]] std::optional<Bearing> bearing() const;
};

}  // namespace tubecut::joint
