#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/joint/contour.hpp"

/// `contact_at`, `continued_hit` and `steepest` for many generators at once: the same numbers, at a
/// quarter of the cost if the cutter is a tube or a plane.
namespace tubecut::joint {

/// Generators of one surface.
struct Stations {
  double radius = 0.0;
  std::vector<double> cos_phi, sin_phi;

  [[nodiscard]] std::size_t size() const { return cos_phi.size(); }
  [[nodiscard]] Generator at(std::size_t i) const { return {radius, cos_phi[i], sin_phi[i]}; }
};
[[nodiscard]] Stations stations_at(double radius, std::span<const double> phi);

/// Heights and cutters of the contour, as `contact_at`; phases in [0, 2 pi), ascending.
struct Contacts {
  std::vector<double> z;
  std::vector<std::size_t> cutter;
};
[[nodiscard]] Contacts contacts_at(const Contour& contour, const Stations& stations,
                                   std::span<const double> phi);

/// Outward unit normals of the cutter that holds each station, as `continued_hit`.
struct Normals {
  std::vector<double> radial, tangential, axial;
};
[[nodiscard]] Normals normals_at(std::span<const PreparedCutter> cutters, const Stations& stations,
                                 std::span<const std::size_t> cutter);

/// Computes dz/dphi of one cutter's sheet at each station, as `continued_hit`.
void slopes_of(const PreparedCutter& cutter, const Stations& stations, std::span<double> out);

/// Returns the largest `steepest` of all cutters at each station on the inner wall.
[[nodiscard]] std::vector<double> steepest_at(std::span<const PreparedCutter> cutters,
                                              const Wall& wall, const Stations& inner,
                                              std::span<const double> z_root);

}  // namespace tubecut::joint
