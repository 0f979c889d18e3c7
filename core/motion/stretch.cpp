#include "core/motion/stretch.hpp"

#include <algorithm>
#include <cstddef>

namespace tubecut::motion {

CutPoint between(const CutPoint& a, const CutPoint& b, double share) {
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  return {mix(a.phi, b.phi),   mix(a.z, b.z), mix(a.b, b.b), false,
          mix(a.beam, b.beam), mix(a.a, b.a)};
}

std::vector<CutPoint> first_stretch(const Track& t, double length) {
  std::vector<CutPoint> out{t.points.front()};
  for (std::size_t i = 1; i < t.points.size() && length > 0.0; ++i) {
    const double step = t.tip_step(i - 1, i);
    const bool whole = step <= length;
    out.push_back(whole ? t.points[i] : between(t.points[i - 1], t.points[i], length / step));
    length -= step;
  }
  return out;
}

std::vector<double> lengths_along(const Track& t) {
  std::vector<double> out(t.points.size(), 0.0);
  for (std::size_t i = 1; i < out.size(); ++i) out[i] = out[i - 1] + t.tip_step(i - 1, i);
  return out;
}

CutPoint at_length(const Track& whole, const std::vector<double>& length, double at) {
  const auto past = static_cast<std::size_t>(std::ranges::upper_bound(length, at) - length.begin());
  const std::size_t before = std::max<std::size_t>(past, 1) - 1;
  if (past == length.size() || length[before] >= at) return whole.points[before];
  const double share = (at - length[before]) / (length[past] - length[before]);
  return between(whole.points[before], whole.points[past], share);
}

Track stretch_of(const Track& whole, const std::vector<double>& length, double from, double to) {
  Track out{.radius = whole.radius, .turns = whole.orientation()};
  const auto first = std::ranges::lower_bound(length, from) - length.begin();
  const auto past = std::ranges::upper_bound(length, to) - length.begin();
  const auto on_point = [&](double at) { return std::ranges::binary_search(length, at); };
  if (!on_point(from)) out.points.push_back(at_length(whole, length, from));
  out.points.insert(out.points.end(), whole.points.begin() + first, whole.points.begin() + past);
  if (!on_point(to)) out.points.push_back(at_length(whole, length, to));
  return out;
}

}  // namespace tubecut::motion
