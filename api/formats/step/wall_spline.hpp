#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace tubecut::api {

/// Maximum distance of a spline from its curve, mm; straight rows become one curve if it can turn
/// from line to line within that.
inline constexpr double kSplineError = 1.5e-3;

/// A closed row of cubic splines, one an edge of the wall, with common knots: the wall is straight
/// from edge to edge at each parameter.
struct WallSpline {
  struct Knot {
    double u = 0.0;
    bool full = true;         // a knot of full multiplicity, at which the curve has a separate
                              // point
    std::size_t control = 0;  // that point, in each edge's list
  };
  std::vector<Knot> knots;                           // the last is the first again, a turn on
  std::vector<std::vector<Eigen::Vector3d>> points;  // of each edge, innermost first
  std::vector<std::vector<Eigen::Vector2d>> flat;  // the same edges in (phi, z), by the same knots
  std::vector<std::size_t> stations;               // knot of each station
};

}  // namespace tubecut::api
