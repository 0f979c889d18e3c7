#pragma once

#include <limits>
#include <span>
#include <stop_token>
#include <vector>

namespace tubecut::math {

/// A closed polygon in the plane; the first point is not repeated, and either way round will do.
struct Polygon {
  std::vector<double> x, y;
};

/// Area of a polygon that does not cross itself.
[[nodiscard]] double area(const Polygon& polygon);

/// A rectangle with its sides along the axes.
struct Window {
  double x_from = -std::numeric_limits<double>::infinity();
  double x_to = std::numeric_limits<double>::infinity();
  double y_from = -std::numeric_limits<double>::infinity();
  double y_to = std::numeric_limits<double>::infinity();
};

/// Area of the union of polygons within a window, by strips between all corners and crossings.
///
/// A polygon that crosses itself counts by the even-odd rule.
/// Accuracy  exact but for rounding: about 1e-14 of the area of what the polygons stand in.
/// Cost      in the corners n log n, each with k log k for the k edges over one x (k^2 where edges
///           cross); ends early, with a part of the area, when told to stop.
[[nodiscard]] double union_area(std::span<const Polygon> polygons, const Window& window = {},
                                const std::stop_token& stop = {});

/// What a polygon encloses more than once, or the wrong way round; 0 of one that does not cross
/// itself, but for rounding.
///
/// Cost      as union_area's.
[[nodiscard]] double crossed_area(const Polygon& polygon, const std::stop_token& stop = {});

}  // namespace tubecut::math
