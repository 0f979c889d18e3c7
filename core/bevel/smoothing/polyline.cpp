#include "core/bevel/smoothing/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel {

void bends(const Points& p, std::size_t from, std::size_t to, double tolerance,
           std::vector<std::size_t>& out) {
  const double dx = p[to].first - p[from].first, dy = p[to].second - p[from].second;
  const double length = elementary::hypot(dx, dy);
  double worst = tolerance;
  std::size_t at = from;
  for (std::size_t k = from + 1; k < to; ++k) {
    const double x = p[k].first - p[from].first, y = p[k].second - p[from].second;
    const double off = length > 0.0 ? std::abs(x * dy - y * dx) / length : elementary::hypot(x, y);
    if (off <= worst) continue;
    worst = off;
    at = k;
  }
  if (at == from) return;
  bends(p, from, at, tolerance, out);
  out.push_back(at);
  bends(p, at, to, tolerance, out);
}

void raise(double& a, double& b, double u, double value) {
  if (!(value > math::mixed(a, b, u))) return;
  double& low = a < b ? a : b;
  const double high = std::max(a, b);
  const double share = a < b ? u : 1.0 - u;  // of the higher end
  const double needed = share < 1.0 ? (value - share * high) / (1.0 - share)
                                    : std::numeric_limits<double>::infinity();
  if (needed <= high) {
    low = needed;
  } else {
    a = b = std::max(high, value);
  }
}

}  // namespace tubecut::bevel
