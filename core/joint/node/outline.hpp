#pragma once

#include <Eigen/Core>

#include "core/section/section.hpp"

/// For `overlaps` only: sections across their axis, height along x.
namespace tubecut::joint::detail {

/// The positions on a line between which it is inside; empty if `to` < `from`.
struct Chord {
  double from = 1.0, to = 0.0;
};

/// A rectangle with round corners. Lengths in mm; without an inside if a half is negative.
struct Outline {
  double half_height = 0.0, half_width = 0.0, corner = 0.0;

  [[nodiscard]] static Outline outside(const section::Section& section);
  [[nodiscard]] static Outline bore(const section::Section& section);

  /// Returns the outline of the places up to this distance outside; < 0: of those further inside
  /// than that. Further inside than its corner radius it has sharp corners.
  [[nodiscard]] Outline moved(double by) const;
  [[nodiscard]] bool empty() const { return half_height < 0.0 || half_width < 0.0; }

  /// Returns the signed distance of a place, negative inside.
  [[nodiscard]] double distance(const Eigen::Vector2d& place) const;
  /// Returns how far it reaches from the axis in the direction of a vector, times its length.
  [[nodiscard]] double support(const Eigen::Vector2d& direction) const;
  /// Returns where a line is inside; `along` is not 0.
  [[nodiscard]] Chord chord(const Eigen::Vector2d& from, const Eigen::Vector2d& along) const;
};

}  // namespace tubecut::joint::detail
