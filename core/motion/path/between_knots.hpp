#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/motion/path/path.hpp"

namespace tubecut::motion {

/// The polyline of a program's tip, to measure how far a curve is off it between two knots: a
/// corner that lies between them is cut by more than the curve is off at either.
///
///     const TipPolyline line(program);
///     const double off = line.farthest_between(control, 12, 0.1, 0.4);
class TipPolyline {
 public:
  explicit TipPolyline(const Program& program);

  /// Returns the largest distance of the curve between knot `i` and the next to the polyline within
  /// `reach` mm of generalised length on both sides of it, mm. `control`: of the coordinates of the
  /// tip, in their order, with knots `d` mm of the same length apart.
  ///
  /// Accuracy  at 15 points between the knots; at a corner by 90 deg within d / 1400.
  [[nodiscard]] double farthest_between(const std::vector<std::vector<double>>& control,
                                        std::size_t i, double d, double reach) const;

 private:
  using Tip = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostCoordinates, 1>;

  std::vector<Tip> points_ = {};
  std::vector<double> weights_ = {};
  std::vector<double> lengths_;
};

}  // namespace tubecut::motion
