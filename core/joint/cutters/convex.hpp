#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/angle.hpp"
#include "core/joint/cutters/kind.hpp"
#include "core/joint/cutters/wall_section.hpp"
#include "core/math/search.hpp"

/// Functions that are the same for every convex kind, or for every kind that a generator meets
/// between its silhouettes.
namespace tubecut::joint {

/// Between two neighbouring silhouettes, either all generators hit or all miss.
template <class Kind>
[[nodiscard]] Met met_between_silhouettes(const Kind& cutter, double rho) {
  const auto hits = [&](double phi) {
    return cutter.upper_sheet(generator_at(rho, phi)).has_value();
  };
  auto phases = cutter.silhouettes(rho);
  if (phases.empty()) return hits(0.5) ? Met::always : Met::never;
  std::ranges::sort(phases);
  phases.push_back(phases.front() + kTwoPi);
  for (std::size_t k = 0; k + 1 < phases.size(); ++k)
    if (hits(0.5 * (phases[k] + phases[k + 1]))) return Met::partly;
  return Met::never;
}

/// Finds z where the line through (x, y) is deepest in a convex solid, because the distance is
/// convex along it.
template <class Solid>
[[nodiscard]] double deepest(const Solid& solid, double x, double y) {
  const auto deep = [&](double z) { return -solid.distance({x, y, z}); };
  // Start near the axis, then expand to both sides until the depth decreases.
  const Eigen::Vector3d from = Eigen::Vector3d(x, y, 0.0) - solid.point;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - solid.direction.z() * solid.direction;
  const double middle = -from.dot(up) / up.squaredNorm();
  double reach = solid.scale();
  for (int i = 0;
       i < 80 && std::max(deep(middle - reach), deep(middle + reach)) > deep(middle) - reach * 1e-3;
       ++i)
    reach *= 2.0;
  return math::golden_maximum(deep, middle - reach, middle + reach).at;
}

template <class Solid>
[[nodiscard]] std::optional<double> convex_top(const Solid& solid, double x, double y) {
  const auto inside = [&](double z) { return solid.distance({x, y, z}) <= 0.0; };
  const double low = deepest(solid, x, y);
  const double size = solid.scale() + (Eigen::Vector3d(x, y, 0.0) - solid.point).norm();
  if (solid.distance({x, y, low}) > 1e-12 * size) return std::nullopt;
  double high = low + solid.scale();
  for (int i = 0; i < 80 && inside(high); ++i) high += high - low;
  return math::last_true(inside, low, high);
}

/// Finds the minimum of the distance, which is unique along a straight line.
template <class Solid>
[[nodiscard]] double convex_least_distance(const Solid& solid, const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b) {
  const auto near = [&](double share) { return -solid.distance(a + share * (b - a)); };
  return std::min({solid.distance(a), solid.distance(0.5 * (a + b)), solid.distance(b),
                   -math::golden_maximum(near, 0.0, 1.0).value});
}

/// Members that are the same for every prepared kind that is convex, smooth between its silhouettes
/// and without kinks; each derives from it.
template <class Kind>
struct PreparedConvex {
  [[nodiscard]] double silhouette_slope(const Generator& /*line*/) const { return 0.0; }
  [[nodiscard]] Hit hit_at_corner(const Generator& line, Side /*side*/) const {
    return kind().continued_hit(line);
  }
  [[nodiscard]] Eigen::Vector3d published_normal(const Generator& line) const {
    return kind().continued_hit(line).normal;
  }
  [[nodiscard]] Met met(double rho) const { return met_between_silhouettes(kind(), rho); }
  [[nodiscard]] std::vector<double> kinks(double /*rho*/) const { return {}; }
  [[nodiscard]] Heights heights_near(const Generator& /*line*/, double /*off*/) const { return {}; }
  [[nodiscard]] double steepest(const Wall& wall, const Generator& inner, double z_root) const {
    return WallSection(kind(), wall, inner).steepest(z_root);
  }
  [[nodiscard]] double support(const Wall& wall, const Generator& inner, double slope) const {
    return WallSection(kind(), wall, inner).support(slope);
  }

 private:
  [[nodiscard]] const Kind& kind() const { return static_cast<const Kind&>(*this); }
};

/// Members that are the same for its solid, from its distance and its scale.
template <class Kind>
struct ConvexSolid {
  [[nodiscard]] std::optional<double> top(double x, double y) const {
    return convex_top(kind(), x, y);
  }
  [[nodiscard]] double clearance(double x, double y) const {
    return kind().distance({x, y, deepest(kind(), x, y)});
  }
  [[nodiscard]] double least_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return convex_least_distance(kind(), a, b);
  }
  [[nodiscard]] double most_hollow(double /*to*/) const { return 0.0; }

 private:
  [[nodiscard]] const Kind& kind() const { return static_cast<const Kind&>(*this); }
};

}  // namespace tubecut::joint
