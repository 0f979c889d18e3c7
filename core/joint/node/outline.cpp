#include "core/joint/node/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns where a line is inside a rectangle about the origin.
Chord across(const Vector2d& half, const Vector2d& from, const Vector2d& along) {
  Chord out{-kInfinity, kInfinity};
  for (const Eigen::Index i : {0, 1}) {
    if (!(half[i] >= 0.0)) return {};
    if (along[i] == 0.0) {
      if (std::abs(from[i]) > half[i]) return {};
      continue;
    }
    const double one = (-half[i] - from[i]) / along[i], two = (half[i] - from[i]) / along[i];
    out.from = std::max(out.from, std::min(one, two));
    out.to = std::min(out.to, std::max(one, two));
  }
  return out;
}

/// Returns where a line is inside a circle about the origin.
Chord across(double radius, const Vector2d& from, const Vector2d& along) {
  const double square = along.squaredNorm();
  const double middle = -from.dot(along) / square;
  const double least = (from + middle * along).norm();
  if (!(least <= radius)) return {};
  const double half = std::sqrt((radius - least) * (radius + least) / square);
  return {middle - half, middle + half};
}

}  // namespace

Outline Outline::outside(const section::Section& s) {
  return {0.5 * s.height, 0.5 * s.width, s.corner};
}

Outline Outline::bore(const section::Section& s) {
  return {0.5 * s.height - s.wall, 0.5 * s.width - s.wall, s.inner_corner};
}

Outline Outline::moved(double by) const {
  return {half_height + by, half_width + by, std::max(0.0, corner + by)};
}

double Outline::distance(const Vector2d& place) const {
  const double x = std::abs(place.x()) - half_height + corner;
  const double y = std::abs(place.y()) - half_width + corner;
  if (x > 0.0 && y > 0.0) return elementary::hypot(x, y) - corner;
  return std::max(x, y) - corner;
}

double Outline::support(const Vector2d& direction) const {
  return std::abs(direction.x()) * (half_height - corner) +
         std::abs(direction.y()) * (half_width - corner) + corner * direction.norm();
}

// It is the union of two rectangles and four discs, and convex.
Chord Outline::chord(const Vector2d& from, const Vector2d& along) const {
  if (empty()) return {};
  Chord out{kInfinity, -kInfinity};
  const auto take = [&](const Chord& part) {
    if (!(part.from <= part.to)) return;
    out.from = std::min(out.from, part.from);
    out.to = std::max(out.to, part.to);
  };
  take(across(Vector2d(half_height, half_width - corner), from, along));
  take(across(Vector2d(half_height - corner, half_width), from, along));
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const Vector2d center(x * (half_height - corner), y * (half_width - corner));
      take(across(corner, from - center, along));
    }
  return out;
}

}  // namespace tubecut::joint::detail
