#include "core/cutout/shadow/profile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tubecut::cutout {
namespace {

using Eigen::Vector2d;

constexpr double kUpright = 1e-7;  // mm: a span so narrow runs along the lines

}  // namespace

Profile::Profile(const std::vector<HullPart>& outline, const Vector2d& c, const Vector2d& w,
                 double sense) {
  const auto seen = [&](const Vector2d& p) { return Vector2d(p.dot(c), sense * p.dot(w)); };
  for (const auto& part : outline) {
    const Vector2d middle = part.at(0.5);
    Span span{.from = 0.0, .to = 0.0, .at = seen(part.from), .end = seen(part.to), .centre = {}};
    Vector2d outward;
    if (part.radius > 0.0) {
      span.centre = seen(part.centre);
      span.radius = part.radius;
      outward = seen(middle) - span.centre;
    } else {
      const Vector2d along = span.end - span.at;
      outward = Vector2d(along.y(), -along.x());
      if (outward.dot(seen(middle)) < 0.0) outward = -outward;
    }
    if (!(outward.y() > 0.0)) continue;
    if (span.at.x() > span.end.x()) std::swap(span.at, span.end);
    span.from = span.at.x();
    span.to = span.end.x();
    if (span.to - span.from > kUpright) spans_.push_back(span);
  }
  std::ranges::sort(spans_, {}, &Span::from);
}

std::size_t Profile::span_at(double c) const {
  std::size_t out = 0;
  while (out + 1 < spans_.size() && c >= spans_[out].to) ++out;
  return out;
}

double Profile::height(std::size_t span, double c) const {
  const auto& one = spans_[span];
  const double here = std::clamp(c, one.from, one.to);
  if (one.radius == 0.0)
    return one.at.y() + (here - one.from) / (one.to - one.from) * (one.end.y() - one.at.y());
  const double off = here - one.centre.x();
  return one.centre.y() + std::sqrt(std::max(0.0, (one.radius - off) * (one.radius + off)));
}

Vector2d Profile::normal(std::size_t span, double c) const {
  const auto& one = spans_[span];
  const double here = std::clamp(c, one.from, one.to);
  if (one.radius == 0.0) {
    const Vector2d along = (one.end - one.at).normalized();
    return {-along.y(), along.x()};
  }
  return (Vector2d(here, height(span, here)) - one.centre).normalized();
}

}  // namespace tubecut::cutout
