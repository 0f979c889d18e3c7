#pragma once

#include <span>
#include <vector>

namespace tubecut::part {

/// A place on the part's outer edge.
struct EdgePoint {
  double phi = 0.0, z = 0.0;
};

/// A closed line around a tube, z over phi (rad, ascending in [0, 2 pi), two equal phases at a
/// jump), straight between its nodes on the developed surface, because the machine interpolates in
/// this way.
struct Edge {
  std::vector<double> phi, z;

  /// Lowest and highest z at phi; they differ only at a jump.
  struct Span {
    double low = 0.0, high = 0.0;
  };
  [[nodiscard]] Span at(double angle) const;
  [[nodiscard]] double lowest() const;
  [[nodiscard]] double highest() const;
  /// Returns the node with the lowest (`upwards` false) or highest z. If several are equal within
  /// 0.01 mm, returns the first after phi = 0, because a tape does not resolve them.
  [[nodiscard]] std::size_t extreme(bool upwards) const;
  /// Computes the integral of z over one revolution, mm rad.
  [[nodiscard]] double turn_integral() const;
};

/// Computes the volume under a ring of edges at ascending radii, straight between them, down to z =
/// 0, mm^3.
/// Source  docs/theory/parts.md, section 3.
[[nodiscard]] double ring_volume(std::span<const double> radii, std::span<const Edge> edges);

}  // namespace tubecut::part
