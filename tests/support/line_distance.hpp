#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace tubecut::testing {

using Real = long double;
using Vec = std::array<Real, 3>;

/// Of p from the line through q along d, by Lagrange's identity.
inline Real from_line(const Vec& p, const Vec& q, const Vec& d) {
  Real pp = 0, pd = 0, dd = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    pp += (p[i] - q[i]) * (p[i] - q[i]);
    pd += (p[i] - q[i]) * d[i];
    dd += d[i] * d[i];
  }
  return std::sqrt(std::max<Real>(0, pp - pd * pd / dd));
}

}  // namespace tubecut::testing
