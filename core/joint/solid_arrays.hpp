#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/joint/solid.hpp"

/// Functions of a solid for many points or lines at once: the same numbers, for a tube at a quarter
/// of the cost.
namespace tubecut::joint {

/// Points in space.
struct PointArrays {
  std::vector<double> x, y, z;

  explicit PointArrays(std::size_t n = 0) : x(n), y(n), z(n) {}
  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Eigen::Vector3d at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Eigen::Vector3d& p) {
    x[i] = p.x();
    y[i] = p.y();
    z[i] = p.z();
  }
};

/// Same as Solid::distance and Solid::least_distance.
void distances(const Solid& solid, const PointArrays& places, std::span<double> out);
void least_distances(const Solid& solid, const PointArrays& from, const PointArrays& to,
                     std::span<double> out);

/// Same as Solid::normal, for the points from `from` to before `to`, at the same indices of `out`.
void normals(const Solid& solid, const PointArrays& places, std::size_t from, std::size_t to,
             PointArrays& out);

/// Replaces each of `least` by the smaller of itself and its neighbour in `other`; NaN stays.
void lower(std::span<double> least, std::span<const double> other);

/// Computes the smallest distance of each path from `from` to `to` to a plain solid, and its
/// fraction along the path.
template <PlainSolid Kind>
void nearest_on_ways(const Kind& solid, const PointArrays& from, const PointArrays& to,
                     std::span<double> share, std::span<double> distance) {
  for (std::size_t i = 0; i < share.size(); ++i) {
    const Eigen::Vector3d a = from.at(i), b = to.at(i);
    share[i] = solid.nearest_share(a, b);
    distance[i] = solid.distance(a + share[i] * (b - a));
  }
}
void nearest_on_ways(const TubeSolid& solid, const PointArrays& from, const PointArrays& to,
                     std::span<double> share, std::span<double> distance);

}  // namespace tubecut::joint
