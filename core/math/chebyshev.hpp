#pragma once

#include <span>
#include <vector>

#include "core/math/search.hpp"

namespace tubecut::math {

/// A polynomial on [from, to] as sum c_k T_k(s), s = 2 (t - from)/(to - from) - 1; c_0 enters
/// whole.
struct ChebyshevSeries {
  double from = -1.0;
  double to = 1.0;
  std::vector<double> coefficients = {};
};

/// Computes p(t) by Clenshaw's recurrence.
/// Accuracy  a few eps of the sum of |c_k| within [from, to].
[[nodiscard]] double value(const ChebyshevSeries& series, double t);

/// Returns int_from^t p, exact as a polynomial; zero at `from`.
[[nodiscard]] ChebyshevSeries antiderivative(const ChebyshevSeries& series);

/// Returns the coefficients of the ascending powers of s in [-1, 1].
[[nodiscard]] std::vector<double> scaled_powers(const ChebyshevSeries& series);

/// Returns the coefficients of the ascending powers of t - from, by composition of `scaled_powers`
/// with s = 2 (t - from)/(to - from) - 1.
[[nodiscard]] std::vector<double> powers(const ChebyshevSeries& series);

/// Computes the polynomial with ascending coefficients at `t`.
[[nodiscard]] double horner(std::span<const double> coefficients, double t);

/// Returns the polynomial of degree `degree` through f at the Chebyshev points of [from, to]. If f
/// is such a polynomial, the result is f itself.
template <class F>
[[nodiscard]] ChebyshevSeries chebyshev_interpolant(F&& f, int degree, double from, double to);

/// Returns the polynomial through (nodes[i], values[i]); the nodes must be distinct.
[[nodiscard]] ChebyshevSeries interpolant(std::span<const double> nodes,
                                          std::span<const double> values, double from, double to);

/// Returns the series of degree values.size() - 1 that takes `values` at
/// `chebyshev_nodes(values.size())`.
[[nodiscard]] ChebyshevSeries from_node_values(std::span<const double> values, double from,
                                               double to);

/// Returns cos(pi (2 i + 1)/(2 count)), i = 0 .. count - 1.
[[nodiscard]] std::vector<double> chebyshev_nodes(int count);

template <class F>
ChebyshevSeries chebyshev_interpolant(F&& f, int degree, double from, double to) {
  std::vector<double> values;
  for (const double s : chebyshev_nodes(degree + 1))
    values.push_back(f(from + 0.5 * (to - from) * (1.0 + s)));
  return from_node_values(values, from, to);
}

}  // namespace tubecut::math
