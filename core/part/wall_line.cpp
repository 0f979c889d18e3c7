#include "core/part/wall_line.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::part {

double WallBox::apart(const WallBox& other, const WallPoint& shift) const {
  const WallPoint off =
      (other.least + shift - most).cwiseMax(least - other.most - shift).cwiseMax(0.0);
  return elementary::hypot(off.x(), off.y());
}

WallLine::WallLine(std::vector<WallPoint> points, bool closed) : points_(std::move(points)) {
  const auto n = points_.size();
  for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
    if (i % kBlock == 0) boxes_.emplace_back();
    segments_.push_back({points_[i], points_[(i + 1) % n]});
    for (const auto& p : {segments_[i].a, segments_[i].b}) {
      boxes_.back().take(p);
      whole_.take(p);
    }
  }
}

bool WallLine::holds(const WallPoint& p) const {
  bool inside = false;
  for (const auto& [a, b] : segments_)
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  return inside;
}

WallWay WallLine::way(const WallPoint& p, const LineSegment& to) {
  const WallPoint along = to.b - to.a;
  const double square = along.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - to.a).dot(along) / square, 0.0, 1.0) : 0.0;
  const WallPoint foot = to.a + t * along;
  return {(foot - p).norm(), p, foot};
}

WallWay WallLine::way(const LineSegment& one, const LineSegment& other) {
  const auto side = [](const LineSegment& of, const WallPoint& p) {
    const WallPoint along = of.b - of.a, from = p - of.a;
    return along.x() * from.y() - along.y() * from.x();
  };
  const double a = side(one, other.a), b = side(one, other.b);
  const double c = side(other, one.a), d = side(other, one.b);
  if (a * b < 0.0 && c * d < 0.0) {
    const WallPoint met = other.a + a / (a - b) * (other.b - other.a);
    return {0.0, met, met};
  }
  WallWay out;
  for (const auto& p : {one.a, one.b})
    if (const auto w = way(p, other); w.length < out.length) out = w;
  for (const auto& p : {other.a, other.b})
    if (const auto w = way(p, one); w.length < out.length) out = {w.length, w.to, w.from};
  return out;
}

std::span<const WallLine::LineSegment> WallLine::block(std::size_t i) const {
  const auto from = i * kBlock;
  return std::span(segments_).subspan(from, std::min(kBlock, segments_.size() - from));
}

/// A bound of the shortest way from above: between the blocks' first points.
double WallLine::reach(const WallLine& other, const WallPoint& shift) const {
  double out = kFar;
  for (std::size_t i = 0; i < segments_.size(); i += kBlock)
    for (std::size_t j = 0; j < other.segments_.size(); j += kBlock)
      out = std::min(out, (other.segments_[j].a + shift - segments_[i].a).squaredNorm());
  return std::sqrt(out) * (1.0 + 1e-12);  // rounding must not hide the pair itself
}

void WallLine::shorten(const WallLine& other, const WallPoint& shift, WallWay& best) const {
  const double within = reach(other, shift);
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for (std::size_t j = 0; j < other.boxes_.size(); ++j) {
      if (boxes_[i].apart(other.boxes_[j], shift) > std::min(best.length, within)) continue;
      if (best.length == 0.0) return;
      for (const auto& segment : block(i))
        for (const auto& [a, b] : other.block(j))
          if (const auto w = way(segment, LineSegment{a + shift, b + shift});
              w.length < best.length)
            best = w;
    }
}

}  // namespace tubecut::part
