#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/joint/cutters/elbow_leg.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kAlong = 24;

}  // namespace

ElbowSolid ElbowCutter::solid() const {
  const Vector3d along = direction.normalized();
  const Vector3d across = -(inwards - inwards.dot(along) * along).normalized();
  return {point - bend_radius * across, along, across, radius, bend_radius, bend.rad()};
}

// Uses the angle around the bend's axis, clamped to the arc, and the feet on the two legs.
Vector3d ElbowSolid::on_centre_line(const Vector3d& p) const {
  const Vector3d from = p - point;
  double turn = elementary::atan2(from.dot(direction), from.dot(across)) - 0.5 * bend;
  turn -= kTwoPi * std::floor(turn / kTwoPi + 0.5);
  const auto at = elementary::sincos(std::clamp(turn, -0.5 * bend, 0.5 * bend) + 0.5 * bend);
  const auto end = elementary::sincos(bend);
  const Vector3d start_point = point + bend_radius * across;
  const Vector3d end_point = point + bend_radius * (end.cos * across + end.sin * direction);
  const Vector3d leaving = end.cos * direction - end.sin * across;
  Vector3d best = point + bend_radius * (at.cos * across + at.sin * direction);
  for (const Vector3d& foot :
       {Vector3d(start_point - std::max(0.0, (start_point - p).dot(direction)) * direction),
        Vector3d(end_point + std::max(0.0, (p - end_point).dot(leaving)) * leaving)})
    if ((p - foot).norm() < (p - best).norm()) best = foot;
  return best;
}

Vector2d ElbowSolid::range(double x, double y) const {
  const auto end = elementary::sincos(bend);
  double flat = 1.0, up = 0.0, down = 0.0;
  for (const Vector3d& along :
       {Vector3d(-direction), Vector3d(end.cos * direction - end.sin * across)}) {
    const double rise = along.z();
    const double sine = elementary::hypot(along.x(), along.y());
    if (sine < kAlongTarget)
      (rise > 0.0 ? up : down) = leg_reach(radius, bend_radius);
    else
      flat = std::min(flat, std::sqrt((1.0 - std::abs(rise)) * (1.0 + std::abs(rise))));
  }
  const double reach = elementary::hypot(x - point.x(), y - point.y()) + bend_radius + radius;
  return {point.z() - std::max(down, 2.0 * reach / flat),
          point.z() + std::max(up, 2.0 * reach / flat)};
}

double ElbowSolid::distance(const Vector3d& p) const {
  return (p - on_centre_line(p)).norm() - radius;
}

Vector3d ElbowSolid::normal(const Vector3d& p) const {
  return (p - on_centre_line(p)).normalized();
}

// If the line grazes the elbow, the steps shrink without end. Therefore every hundredth step
// searches the nearest point below, within the smallest curvature that the distance can have. A
// point within `near` of the surface is further away from it along the line, so Newton's steps end
// on the surface.
std::optional<double> ElbowSolid::top(double x, double y) const {
  constexpr int kDown = 20'000, kPatience = 100;
  constexpr double kLanding = 1e-4;  // mm; if a step were longer, the line would be tangent there
  const auto between = range(x, y);
  const double near = 1e-12 * (radius + bend_radius + std::abs(point.z()));
  const auto away = [&](double at) { return distance({x, y, at}); };
  const auto landed = [&](double at) {
    for (int step = 0; step < 3; ++step) {
      const double falling = normal({x, y, at}).z();
      const double by = away(at) / falling;
      if (falling <= 0.0 || std::abs(by) > kLanding) break;
      at -= by;
    }
    return at;
  };
  double z = between[1];
  for (int step = 1; step < kDown && z > between[0]; ++step) {
    const double gap = away(z);
    if (gap <= near) return landed(z);
    if (step % kPatience == 0) {
      const double below = 4.0 * std::sqrt(2.0 * (radius + bend_radius) * gap);
      const double deep =
          math::golden_maximum([&](double at) { return -away(at); }, z - below, z).at;
      if (away(deep) <= near)
        return landed(math::last_true([&](double at) { return away(at) <= near; }, deep, z));
    }
    z -= gap;
  }
  return std::nullopt;
}

double ElbowSolid::clearance(double x, double y) const {
  constexpr int kSamples = 400;
  const auto between = range(x, y);
  std::vector<double> z, deep;
  const auto depth = [&](double at) { return -distance({x, y, at}); };
  for (int k = 0; k <= kSamples; ++k) {
    z.push_back(between[0] + (between[1] - between[0]) * k / kSamples);
    deep.push_back(depth(z.back()));
  }
  return -math::grid_maximum(depth, z, deep).value;
}

// The distance along a line may have several minima, so they are searched on a grid.
double ElbowSolid::least_distance(const Vector3d& a, const Vector3d& b) const {
  const auto near = [&](double share) { return -distance(a + share * (b - a)); };
  std::vector<double> grid, sampled;
  for (int k = 0; k <= kAlong; ++k) {
    grid.push_back(static_cast<double>(k) / kAlong);
    sampled.push_back(near(grid.back()));
  }
  return std::min({distance(a), distance(0.5 * (a + b)), distance(b),
                   -math::grid_maximum(near, grid, sampled).value});
}

// The centre line, an arc of at most half a turn with its legs, keeps at least its bend radius R
// from itself: within s < R of it the distance bends inwards by at most 1/(R - s).
double ElbowSolid::most_hollow(double to) const {
  const double room = bend_radius - std::max(0.0, radius + to);
  return room > 0.0 ? 1.0 / room : kInfinity;
}

}  // namespace tubecut::joint
