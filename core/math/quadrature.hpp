#pragma once

#include <vector>

namespace tubecut::math {

struct GaussRule {
  std::vector<double> nodes;    // in (-1, 1), ascending
  std::vector<double> weights;  // sum 2
};

/// Gauss-Legendre rule of `count` >= 1 points: exact for polynomials of degree 2 count - 1.
///
/// Accuracy  nodes and weights within a few eps (worst seen for 64 points: integral of s^126 off by
///           8.5e-15 of itself).
/// Cost      count^2 times a handful; at most 16 Newton steps a node from Tricomi's start.
[[nodiscard]] GaussRule gauss_legendre(int count);

/// P_0(s) .. P_degree(s), Legendre.
[[nodiscard]] std::vector<double> legendre(int degree, double s);

}  // namespace tubecut::math
