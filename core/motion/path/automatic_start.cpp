#include "core/motion/path/automatic_start.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

constexpr double kSameTilt = 1e-6;  // rad
constexpr double kLonger = 0.5;     // mm

/// Computes the angle between the beam and the wall's normal.
double tilt(const CutPoint& p) {
  if (p.a == 0.0) return std::abs(p.b);
  return elementary::atan(elementary::hypot(elementary::tan(p.a), elementary::tan(p.b)));
}

/// Reduces the distances to those from the ends of the flat that each point lies on; 0 on an arc.
void keep_off_arcs(const Track& t, std::vector<double>& distance) {
  const auto outside = t.section->outer();
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const auto at = outside.at(t.radius * t.points[i].phi);
    const double off = outside.half_flat(at.face) - std::abs(at.along);
    distance[i] = at.on_corner ? 0.0 : std::min(distance[i], off);
  }
}

/// Returns how far an opening runs straight on both sides of a point: up to its neighbours.
double straight_run(const Track& t, std::size_t i) {
  constexpr double kStraightCos = 0.9998;  // 1 deg
  const std::size_t n = t.points.size() - 1;
  if (t.turns != 0) return 0.0;
  const CutPoint &o = t.points[i], &a = t.points[i == 0 ? n - 1 : i - 1], &b = t.points[i + 1];
  const double ax = t.radius * (o.phi - a.phi), az = o.z - a.z;
  const double bx = t.radius * (b.phi - o.phi), bz = b.z - o.z;
  const double before = elementary::hypot(ax, az), after = elementary::hypot(bx, bz);
  return ax * bx + az * bz < kStraightCos * before * after ? 0.0 : std::min(before, after);
}

}  // namespace

std::size_t automatic_start(const Track& t, const std::optional<Angle>& seam) {
  std::vector<double> distance = from_corner(t);
  for (std::size_t i = 0; seam && i < distance.size(); ++i) {
    const double turned = std::remainder(t.points[i].phi - seam->rad(), kTwoPi);
    distance[i] = std::min(distance[i], t.radius * std::abs(turned));
  }
  if (t.section) keep_off_arcs(t, distance);
  std::size_t best = 0;
  const auto better = [&](std::size_t a, std::size_t b) {
    const bool a_clear = distance[a] >= kFromJunction, b_clear = distance[b] >= kFromJunction;
    if (a_clear != b_clear) return a_clear;
    if (!a_clear) return distance[a] > distance[b];
    const double more = tilt(t.points[a]) - tilt(t.points[b]);
    if (std::abs(more) > kSameTilt || t.turns != 0) return more < 0.0;
    return straight_run(t, a) > straight_run(t, b) + kLonger;
  };
  for (std::size_t i = 1; i < distance.size(); ++i) {
    if (better(i, best)) best = i;
  }
  return best;
}

}  // namespace tubecut::motion
