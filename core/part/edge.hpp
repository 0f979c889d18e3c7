#pragma once

#include <span>
#include <vector>

namespace tubecut::part {

/// A closed line around a tube, z over phi (rad, ascending in [0, 2 pi), two equal phases at a
/// jump), straight between its nodes on the developed surface: as the machine goes.
struct Edge {
  std::vector<double> phi, z;

  /// Lowest and highest z at phi; they differ only at a jump.
  struct Span {
    double low = 0.0, high = 0.0;
  };
  [[nodiscard]] Span at(double angle) const;
  [[nodiscard]] double lowest() const;
  [[nodiscard]] double highest() const;
  /// The node with the lowest (`upwards` false) or highest z. Of several that stand out alike,
  /// within 0.01 mm, the first after phi = 0: a tape does not tell them apart.
  [[nodiscard]] std::size_t extreme(bool upwards) const;
  /// Integral of z over the whole turn, mm rad.
  [[nodiscard]] double turn_integral() const;
};

/// Volume under a ring of edges at ascending radii, straight between them, down to z = 0, mm^3.
/// Source  docs/theory/parts.md, section 3.
[[nodiscard]] double ring_volume(std::span<const double> radii, std::span<const Edge> edges);

}  // namespace tubecut::part
