#include "core/groove/periodic_spline.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace tubecut::groove {
namespace {

/// Solves m[i-1] + 4 m[i] + m[i+1] = rhs[i] around one revolution. The system's inverse is a sum of
/// two decaying geometric series with ratio sqrt(3) - 2, so one sweep forward and one back, each
/// closed over the revolution, are exact.
std::vector<double> solve_round(std::vector<double> rhs) {
  const std::size_t n = rhs.size();
  const double ratio = std::sqrt(3.0) - 2.0;
  double turn = 1.0;  // ratio^n
  for (std::size_t i = 0; i < n; ++i) turn *= ratio;
  const auto sweep = [&](auto index) {
    double carry = 0.0;
    for (std::size_t i = 0; i < n; ++i) carry = rhs[index(i)] + ratio * carry;
    carry /= 1.0 - turn;  // the value before the first, one revolution later
    for (std::size_t i = 0; i < n; ++i) carry = rhs[index(i)] = rhs[index(i)] + ratio * carry;
  };
  sweep([](std::size_t i) { return i; });
  sweep([n](std::size_t i) { return n - 1 - i; });
  for (double& value : rhs) value *= -ratio;
  return rhs;
}

}  // namespace

PeriodicSpline::PeriodicSpline(std::vector<double> values) : values_(std::move(values)) {
  const std::size_t n = values_.size();
  std::vector<double> rhs(n);
  for (std::size_t i = 0; i < n; ++i)
    rhs[i] = 6.0 * (values_[(i + 1) % n] - 2.0 * values_[i] + values_[(i + n - 1) % n]);
  bends_ = solve_round(std::move(rhs));
}

PeriodicSpline::SplinePosition PeriodicSpline::position(double station) const {
  const double whole = std::floor(station), n = double(values_.size());
  const auto i = std::size_t(whole - n * std::floor(whole / n));
  return {i, (i + 1) % values_.size(), station - whole};
}

double PeriodicSpline::operator()(double station) const {
  const auto [i, j, t] = position(station);
  const double u = 1.0 - t;
  return u * values_[i] + t * values_[j] +
         ((u * u * u - u) * bends_[i] + (t * t * t - t) * bends_[j]) / 6.0;
}

double PeriodicSpline::slope(double station) const {
  const auto [i, j, t] = position(station);
  const double u = 1.0 - t;
  return values_[j] - values_[i] +
         ((1.0 - 3.0 * u * u) * bends_[i] + (3.0 * t * t - 1.0) * bends_[j]) / 6.0;
}

}  // namespace tubecut::groove
