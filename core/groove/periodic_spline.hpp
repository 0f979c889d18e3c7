#pragma once

#include <cstddef>
#include <vector>

namespace tubecut::groove {

/// The periodic cubic spline through values at equal steps of one revolution; four or more values.
class PeriodicSpline {
 public:
  explicit PeriodicSpline(std::vector<double> values);

  [[nodiscard]] std::size_t count() const { return values_.size(); }
  /// Computes the value at `station` steps from the first value; any real number.
  ///
  /// Accuracy  (5/384) of the fourth difference of a smooth function.
  [[nodiscard]] double operator()(double station) const;
  /// Computes its derivative, per step.
  [[nodiscard]] double slope(double station) const;

 private:
  /// The position of a station: between values i and j, at the fraction t.
  struct SplinePosition {
    std::size_t i, j;
    double t;
  };
  [[nodiscard]] SplinePosition position(double station) const;

  std::vector<double> values_;
  std::vector<double> bends_;  // second derivatives, per step^2
};

}  // namespace tubecut::groove
