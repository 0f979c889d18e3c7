#include "core/motion/path/stretch.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace tubecut::motion {
namespace {

/// mm; a place nearer to a point than this counts as that point, because an inserted point would
/// round to the same, and a path with a repeated point has no direction there.
constexpr double kSamePlace = 1e-8;

/// Returns the points within kSamePlace of a length: the first and one past the last.
std::pair<std::size_t, std::size_t> points_at(const std::vector<double>& length, double at) {
  const auto first = std::ranges::lower_bound(length, at - kSamePlace) - length.begin();
  const auto past = std::ranges::upper_bound(length, at + kSamePlace) - length.begin();
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(past)};
}

}  // namespace

CutPoint between(const WallRadii& wall, const CutPoint& a, const CutPoint& b, double share) {
  const auto at =
      between(wall, TorchLean{a.phi, a.z, a.b, a.a}, TorchLean{b.phi, b.z, b.b, b.a}, share);
  return {at.phi, at.z, at.b, false, a.beam + share * (b.beam - a.beam), at.a};
}

std::vector<CutPoint> first_stretch(const Track& t, double length) {
  std::vector<CutPoint> out{t.points.front()};
  for (std::size_t i = 1; i < t.points.size() && length > kSamePlace; ++i) {
    const double step = t.tip_step(i - 1, i);
    const bool whole = step <= length + kSamePlace;
    out.push_back(whole ? t.points[i]
                        : between(t.wall, t.points[i - 1], t.points[i], length / step));
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
  const auto [first, past] = points_at(length, at);
  if (first < past || past == length.size()) return whole.points[past - 1];
  const double share = (at - length[past - 1]) / (length[past] - length[past - 1]);
  return between(whole.wall, whole.points[past - 1], whole.points[past], share);
}

Track stretch_of(const Track& whole, const std::vector<double>& length, double from, double to) {
  Track out{.radius = whole.radius, .turns = whole.orientation(), .wall = whole.wall};
  const auto begin = points_at(length, from), end = points_at(length, to);
  if (begin.first == begin.second) out.points.push_back(at_length(whole, length, from));
  const auto all = whole.points.begin();
  out.points.insert(out.points.end(), all + static_cast<std::ptrdiff_t>(begin.first),
                    all + static_cast<std::ptrdiff_t>(end.second));
  if (end.first == end.second) out.points.push_back(at_length(whole, length, to));
  return out;
}

}  // namespace tubecut::motion
