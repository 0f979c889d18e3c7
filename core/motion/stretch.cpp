#include "core/motion/stretch.hpp"

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

Track stretch_of(const Track& whole, double from, double to) {
  const auto length = lengths_along(whole);
  Track out{.radius = whole.radius, .turns = whole.orientation()};
  for (std::size_t i = 0; i < length.size(); ++i) {
    const auto inserted = [&](double at) {
      if (i > 0 && length[i - 1] < at && at < length[i])
        out.points.push_back(between(whole.points[i - 1], whole.points[i],
                                     (at - length[i - 1]) / (length[i] - length[i - 1])));
    };
    inserted(from);
    inserted(to);
    if (from <= length[i] && length[i] <= to) out.points.push_back(whole.points[i]);
  }
  return out;
}

}  // namespace tubecut::motion
