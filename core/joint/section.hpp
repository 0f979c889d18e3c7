#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/joint/cutters/cutter.hpp"

namespace tubecut::joint {

/// A generator of a target of any cross-section: where it stands and the surface's outward normal
/// there. The tangent is the normal a quarter turn on, the way phi grows.
struct SectionPoint {
  Eigen::Vector2d at = Eigen::Vector2d::UnitX();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // unit

  [[nodiscard]] Eigen::Vector2d tangent() const { return {-normal.y(), normal.x()}; }
};

/// A cutter's hit on such a generator. `normal` is the cutter's, as (normal, tangent, axial) of the
/// section, so that groove rules take it as it is; z_dphi is dz per mm along the tangent, z_dphi2
/// is not given (0).
[[nodiscard]] std::optional<Hit> hit(const PreparedCutter& cutter, const SectionPoint& generator);

/// The outside of a rectangular tube, mm; sides along x and y.
struct RectangularSection {
  double width = 0.0;   // along x
  double height = 0.0;  // along y
  double corner = 0.0;  // > 0, at most half the smaller side

  [[nodiscard]] double perimeter() const;
  /// The point after `s` mm of perimeter, [0, perimeter), from the middle of the side at +x on.
  [[nodiscard]] SectionPoint at(double s) const;
  /// The perimeters at which sides and corners meet, ascending.
  [[nodiscard]] std::vector<double> seams() const;
  /// The surface `depth` further in.
  [[nodiscard]] RectangularSection inset(double depth) const;
};

/// One node of a cut around a section.
struct SectionNode {
  double s = 0.0;
  SectionPoint generator;
  std::size_t cutter = 0;
  Hit hit;
};

/// The end of a rectangular prism against its cutters: highest hit and partner, with the seams and
/// changes of partner as nodes, straight within `tolerance` in the developed surface (s, z).
///
/// Not offered by the service yet: its targets are round.
/// Errors    those of `prepare`; open_profile (cutters; got = intervals of s in mm), out_of_range
///           (section/corner, tolerance).
/// Accuracy  a change of partner is bracketed between neighbours 1/64 of a stretch apart.
[[nodiscard]] Result<std::vector<SectionNode>> section_contour(std::span<const Cutter> cutters,
                                                               const RectangularSection& section,
                                                               double tolerance);

}  // namespace tubecut::joint
