#pragma once

#include <vector>

namespace tubecut::groove {

/// The periodic cubic spline through values at equal steps of one turn; four or more values.
class PeriodicSpline {
 public:
  explicit PeriodicSpline(std::vector<double> values);

  /// Value at `station` steps from the first value; any real number.
  ///
  /// Accuracy  (5/384) of the fourth difference of a smooth function.
  [[nodiscard]] double operator()(double station) const;

 private:
  std::vector<double> values_;
  std::vector<double> bends_;  // second derivatives, per step^2
};

}  // namespace tubecut::groove
