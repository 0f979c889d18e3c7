#include "core/cutout/shape.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::cutout {

Flat SlitLine::nearest(const Flat& p) const {
  const Flat along = to - from;
  return from + std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

std::vector<Flat> SlitLine::way(Slit::Pierce pierce, double apart) const {
  std::vector<Flat> out;
  const auto go = [&](const Flat& a, const Flat& b) {
    const int parts = std::max(2, static_cast<int>(std::ceil((b - a).norm() / apart)));
    if (out.empty()) out.push_back(a);
    for (int i = 1; i <= parts; ++i) out.push_back(a + static_cast<double>(i) / parts * (b - a));
  };
  if (pierce == Slit::Pierce::middle) go(0.5 * (from + to), from);
  go(from, to);
  return out;
}

SlitLine slit_line(const Slit& slit, double turn) {
  const auto [sin, cos] = elementary::sincos(turn);
  const Flat half = 0.5 * slit.length * Flat(cos, sin);
  return half.x() < 0.0 ? SlitLine{half, -half} : SlitLine{-half, half};
}

}  // namespace tubecut::cutout
