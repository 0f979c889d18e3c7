#include "core/math/chebyshev.hpp"

#include <cstddef>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::math {

double value(const ChebyshevSeries& series, double t) {
  const double s = (2.0 * t - series.from - series.to) / (series.to - series.from);
  double next = 0.0;
  double after = 0.0;
  for (std::size_t k = series.coefficients.size(); k-- > 1;) {
    const double here = 2.0 * s * next - after + series.coefficients[k];
    after = next;
    next = here;
  }
  return s * next - after + series.coefficients[0];
}

ChebyshevSeries antiderivative(const ChebyshevSeries& series) {
  const auto& c = series.coefficients;
  const auto at = [&c](std::size_t k) { return k < c.size() ? c[k] : 0.0; };
  const double half_width = 0.5 * (series.to - series.from);
  ChebyshevSeries out{series.from, series.to, std::vector<double>(c.size() + 1)};
  double at_start = 0.0;
  for (std::size_t k = 1; k <= c.size(); ++k) {
    const double below = k == 1 ? 2.0 * at(0) : at(k - 1);
    out.coefficients[k] = half_width * (below - at(k + 1)) / (2.0 * static_cast<double>(k));
    at_start += (k % 2 == 0 ? 1.0 : -1.0) * out.coefficients[k];
  }
  out.coefficients[0] = -at_start;
  return out;
}

std::vector<double> scaled_powers(const ChebyshevSeries& series) {
  const std::size_t n = series.coefficients.size();
  std::vector<double> out(n), here(n), before(n);
  here[0] = 1.0;  // T_0
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i <= k; ++i) out[i] += series.coefficients[k] * here[i];
    std::vector<double> next(n);
    const double factor = k == 0 ? 1.0 : 2.0;
    for (std::size_t i = 0; i + 1 < n; ++i) next[i + 1] = factor * here[i];
    for (std::size_t i = 0; i < n; ++i) next[i] -= k == 0 ? 0.0 : before[i];
    before = std::move(here);
    here = std::move(next);
  }
  return out;
}

std::vector<double> powers(const ChebyshevSeries& series) {
  auto out = scaled_powers(series);
  const std::size_t n = out.size();
  for (std::size_t pass = 0; pass + 1 < n; ++pass)  // Taylor shift: powers of s + 1
    for (std::size_t i = n - 1; i-- > pass;) out[i] -= out[i + 1];
  const double rate = 2.0 / (series.to - series.from);
  double scale = 1.0;
  for (double& c : out) {
    c *= scale;
    scale *= rate;
  }
  return out;
}

double horner(std::span<const double> coefficients, double t) {
  double sum = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * t + coefficients[k];
  return sum;
}

std::vector<double> chebyshev_nodes(int count) {
  std::vector<double> nodes;
  for (int i = 0; i < count; ++i) nodes.push_back(elementary::cos(kPi * (2 * i + 1) / (2 * count)));
  return nodes;
}

ChebyshevSeries from_node_values(std::span<const double> values, double from, double to) {
  const auto n = static_cast<int>(values.size());
  ChebyshevSeries out{from, to, std::vector<double>(values.size())};
  for (int k = 0; k < n; ++k) {
    double sum = 0.0;  // discrete orthogonality of T_k over the nodes
    for (int i = 0; i < n; ++i)
      sum += values[static_cast<std::size_t>(i)] * elementary::cos(kPi * k * (2 * i + 1) / (2 * n));
    out.coefficients[static_cast<std::size_t>(k)] = (k == 0 ? 1.0 : 2.0) * sum / n;
  }
  return out;
}

ChebyshevSeries interpolant(std::span<const double> nodes, std::span<const double> values,
                            double from, double to) {
  std::vector<double> divided(values.begin(), values.end());  // Newton's divided differences
  for (std::size_t order = 1; order < nodes.size(); ++order)
    for (std::size_t i = nodes.size(); i-- > order;)
      divided[i] = (divided[i] - divided[i - 1]) / (nodes[i] - nodes[i - order]);
  const auto newton = [&](double t) {
    double sum = 0.0;
    for (std::size_t k = divided.size(); k-- > 0;) sum = sum * (t - nodes[k]) + divided[k];
    return sum;
  };
  return chebyshev_interpolant(newton, static_cast<int>(nodes.size()) - 1, from, to);
}

}  // namespace tubecut::math
