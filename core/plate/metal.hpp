#pragma once

#include <optional>
#include <vector>

#include "core/plate/plate.hpp"

namespace tubecut::plate {

/// A finished plate as a body.
class Metal {
 public:
  Metal(const Plate& plate, double thickness);

  /// Returns how deep a place of the plate's frame is in it; below 0 outside.
  [[nodiscard]] double depth(const Eigen::Vector3d& p) const;
  [[nodiscard]] const Plate& plate() const { return plate_; }
  [[nodiscard]] double thickness() const { return thickness_; }
  /// Returns true if the boxes of both in the world overlap.
  [[nodiscard]] bool near(const Metal& other) const;

 private:
  const Plate& plate_;
  double thickness_;
  std::vector<cutout::Bounds> boxes_;  // of the openings
  Eigen::Vector3d low_, high_;         // of all of it, in the world
};

/// Overlaps of two plates of at most this depth are not reported, because directions are written
/// with few decimals: 5e-4 rad over 200 mm.
inline constexpr double kLeastPlates = 0.1;  // mm

struct SharedPlace {
  double depth = 0.0;                            // in both, mm
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // in the world
};
/// Returns the deepest place found in the metal of both plates; empty if none is deeper than
/// `kLeastPlates`. The metal of a plate that is cut square, seen along the line in which the two
/// planes meet, is a set of intervals of that line, so both are compared on lines of that direction
/// at several depths of each plate and next to each corner of its outline.
///
/// Accuracy  a common part is found if a line meets it: between corners they are at most
///           `kBetweenLines` of the common width from each other.
/// Cost      10 us for each segment of both outlines; less if the plates are far from each other.
[[nodiscard]] std::optional<SharedPlace> shared_metal(const Metal& a, const Metal& b);
inline constexpr double kBetweenLines = 1.0 / 48.0;

}  // namespace tubecut::plate
