#pragma once

#include <Eigen/Core>

namespace tubecut::bevel {

/// weight/2 (x + share y)^2 + rest/2 y^2, a quadratic in two unknowns that only ever grows: what is
/// added never cancels.
template <class Real>
struct Squares {
  Real weight = 0.0, share = 0.0, rest = 0.0;

  /// Adds q/2 (of_x x + of_y y)^2, q >= 0.
  void add(Real q, Real of_x, Real of_y);
};

/// Least of a quadratic over a closed path: heights f_j, the slopes v_j after them and the bends
/// u_j = v_j - v_{j-1} before those, f_{j+1} = f_j + h_j v_j. It sums, over j,
///
///     1/2 height_j f_j^2 + 1/2 slope_j v_j^2 + 1/2 bend_j u_j^2
///
/// and a linear term of each. Backwards round the ring the cost to go stays a sum of squares, so
/// weights from 1e-300 to 1e60 stand beside one another and steps of any length: nothing is
/// subtracted that could cancel. A height weight of 1e60 pins the height.
///
/// `Real` is what it reckons in: double, or long double where that is not enough.
/// Cost  five divisions a node to factor, none to solve.
template <class Real>
class RingNewton {
 public:
  using Array = Eigen::ArrayXd;

  /// h: from each node to the next, > 0. Kept by reference.
  explicit RingNewton(const Array& h);

  /// Weights: height and bend > 0, slope >= 0.
  void factor(const Array& height, const Array& slope, const Array& bend);

  /// With the linear terms of f, v and u, after `factor`.
  void solve(const Array& of_f, const Array& of_v, const Array& of_u, Array& f, Array& v);

 private:
  const Array& h_;
  Eigen::Array<Real, Eigen::Dynamic, 1> gain_, from_f_, from_v_, from_end_f_, from_end_v_,
      kick_;           // of the slope after each node
  Squares<Real> end_;  // in height and slope where the ring is cut
};

}  // namespace tubecut::bevel
