#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/joint/cutters/cutter.hpp"
#include "core/joint/node/sheets.hpp"

namespace tubecut::joint::detail {

/// z = mid +- sqrt(square) of one piece of a cutter over the whole plane: mid of degree 1, square
/// of degree 2 in x and y.
struct PlaneSheets {
  double mid;
  Eigen::Vector2d mid_slope;
  double square;
  Eigen::Vector2d square_slope;
  Eigen::Matrix2d square_bend;  // half the second derivatives
  double size;
  bool curved;
};
/// Returns the pieces of a cutter; none if it has no closed form. `radius` is a length of the
/// section.
[[nodiscard]] std::vector<PlaneSheets> plane_sheets(const PreparedCutter& cutter, double radius);

/// Two sheets along a straight line, by the share x of its length: coefficients of x^0, x^1, x^2.
struct LineSheets {
  std::array<double, 2> mid;
  std::array<double, 3> square;
  bool curved;
};
[[nodiscard]] LineSheets along_line(const PlaneSheets& sheets, const Eigen::Vector2d& from,
                                    const Eigen::Vector2d& way);

/// Returns shares near every solution of mid_a +- sqrt(square_a) = mid_b +- sqrt(square_b) in [0,
/// 1], and perhaps others.
[[nodiscard]] std::vector<double> crossings(const LineSheets& a, const LineSheets& b);

}  // namespace tubecut::joint::detail
