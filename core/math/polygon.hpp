#pragma once

#include <limits>
#include <span>
#include <vector>

namespace tubecut::math {

/// A closed polygon in the plane, in either direction; the first point is not repeated.
struct Polygon {
  std::vector<double> x, y;
};

/// Computes the area of a polygon that does not cross itself.
[[nodiscard]] double area(const Polygon& polygon);

/// A rectangle with its sides along the axes.
struct Window {
  double x_from = -std::numeric_limits<double>::infinity();
  double x_to = std::numeric_limits<double>::infinity();
  double y_from = -std::numeric_limits<double>::infinity();
  double y_to = std::numeric_limits<double>::infinity();
};

/// Computes the area of the union of polygons within a window, by strips between all corners and
/// crossings.
///
/// If a polygon crosses itself, it counts by the even-odd rule.
/// Accuracy  exact except for rounding: about 1e-14 of the area that contains the polygons.
/// Cost      in the corners n log n, each with k log k for the k edges over one x (k^2 if edges
///           cross). If cancelled, returns early with a part of the area.
[[nodiscard]] double union_area(std::span<const Polygon> polygons, const Window& window = {});

/// Computes the area that a polygon encloses more than once or in reverse; 0 except for rounding if
/// it does not cross itself.
///
/// Cost      as union_area's.
[[nodiscard]] double crossed_area(const Polygon& polygon);

}  // namespace tubecut::math
