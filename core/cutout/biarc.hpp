#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/cutout/chain.hpp"

/// Curves of a local plane as pairs of circular arcs.
namespace tubecut::cutout {

/// A line or an arc of a drawing that is `mirrored`, from `from`, where it runs along `along`.
inline DrawnSegment bow(const Flat& from, const Flat& along, const Flat& to, bool backwards) {
  constexpr double kStraight = 1e-6;  // rad: an arc so flat has its centre too far off
  const Flat left(-along.y(), along.x()), way = to - from;
  const double rise = left.dot(way);
  if (std::abs(rise) < kStraight * way.norm()) return {.to = backwards ? from : to};
  return {.to = backwards ? from : to,
          .centre = from + left * (way.squaredNorm() / (2.0 * rise)),
          .clockwise = rise < 0.0};
}

/// Adds a smooth curve as pairs of arcs with its ends and tangents, halved until they are `within`
/// of it. `from`: its first place, or where the drawing ends, as good as there. A curve has the
/// places at(share) with the unit tangents along(share), and a first() and a second() half.
/// Accuracy  at seven places of each pair; a curve halved `halvings` times stays as it is.
template <class Curve>
void add_biarcs(const Curve& curve, const Flat& from, double within, int halvings,
                std::vector<DrawnSegment>& out) {
  constexpr double kNoLength = 1e-5;  // mm: no piece of a drawing
  const Flat to = curve.at(1.0), way = to - from;
  if (!(way.norm() > kNoLength)) return;
  const Flat a = curve.along(0.0), b = curve.along(1.0), sum = a + b;
  const double bent = 2.0 * (1.0 - a.dot(b));
  const double along = way.dot(sum);
  const double reach =
      way.squaredNorm() / (along + std::sqrt(along * along + bent * way.squaredNorm()));
  const Flat middle = 0.5 * ((from + reach * a) + (to - reach * b));
  const auto first = bow(from, a, middle, false);
  auto second = bow(to, -b, middle, true);
  second.clockwise = !second.clockwise;
  double off = 0.0;
  for (const double share : {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875}) {
    const Flat p = curve.at(share);
    const bool before = (p - middle).dot(way) < 0.0;
    const auto& one = before ? first : second;
    const Flat chord = before ? Flat(middle - from) : Flat(to - middle);
    off = std::max(off, one.centre
                            ? std::abs((p - *one.centre).norm() - (middle - *one.centre).norm())
                            : std::abs(cross(chord, p - middle)) / chord.norm());
  }
  if (off > within && halvings > 0) {
    add_biarcs(curve.first(), from, within, halvings - 1, out);
    add_biarcs(curve.second(), out.empty() ? from : out.back().to, within, halvings - 1, out);
    return;
  }
  out.push_back(first);
  out.push_back(second);
}

}  // namespace tubecut::cutout
