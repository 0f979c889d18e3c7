#include "core/math/quadrature.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::math {
namespace {

struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

ValueAndSlope legendre_with_slope(int degree, double s) {
  const auto p = legendre(degree, s);
  const auto n = static_cast<std::size_t>(degree);
  return {p[n], degree * (p[n - 1] - s * p[n]) / ((1.0 - s) * (1.0 + s))};
}

}  // namespace

std::vector<double> legendre(int degree, double s) {
  std::vector<double> p{1.0};
  if (degree >= 1) p.push_back(s);
  for (int k = 2; k <= degree; ++k) {
    const auto i = static_cast<std::size_t>(k);
    p.push_back(((2 * k - 1) * s * p[i - 1] - (k - 1) * p[i - 2]) / k);
  }
  return p;
}

GaussRule gauss_legendre(int count) {
  GaussRule rule;
  for (int i = count; i >= 1; --i) {
    double s = elementary::cos(kPi * (i - 0.25) / (count + 0.5));
    for (int step = 0; step < 16; ++step) {
      const auto here = legendre_with_slope(count, s);
      const double change = here.value / here.slope;
      s -= change;
      if (std::abs(change) <= std::numeric_limits<double>::epsilon()) break;
    }
    const double slope = legendre_with_slope(count, s).slope;
    rule.nodes.push_back(s);
    rule.weights.push_back(2.0 / ((1.0 - s) * (1.0 + s) * slope * slope));
  }
  return rule;
}

}  // namespace tubecut::math
