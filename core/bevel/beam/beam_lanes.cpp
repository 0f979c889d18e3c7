#include "core/bevel/beam/beam_lanes.hpp"

#include <cmath>

#include "core/base/lanes.hpp"
#include "core/base/pack.hpp"

namespace tubecut::bevel::beam {
namespace {

constexpr int kSteps = 4;           // of Newton, from the parabola through three points
constexpr double kGained = 1e-6;    // of a squared distance: a smaller gain ends the iteration
constexpr double kParabola = 0.05;  // likewise: no parabola is further below it
constexpr double kTiny = 1e-300;    // of a bend

struct Vector {
  double x, y, z;
};
TUBECUT_INLINE double dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
TUBECUT_INLINE Vector of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
TUBECUT_INLINE Vector from(const Vector& a, const Vector& b) {
  return {b.x - a.x, b.y - a.y, b.z - a.z};
}
TUBECUT_INLINE Vector along(const Vector& a, double s, const Vector& d) {
  return {a.x + s * d.x, a.y + s * d.y, a.z + s * d.z};
}

TUBECUT_INLINE void all_squares(const AxisAt& axis, double floor, const EightPoints& points,
                                Eight& out, std::size_t n) {
  const Vector p = of(axis.p), d = of(axis.d);
  const double inverse = axis.inverse;
  for (std::size_t l = 0; l < n; ++l) {
    const Vector off = from(p, {points.x[l], points.y[l], points.z[l]});
    const double foot = dot(off, d) * inverse, s = foot > floor ? foot : floor;
    const Vector left = along(off, -s, d);
    out[l] = dot(left, left);
  }
}

TUBECUT_INLINE void take_less(double stretch, double share, const Eight& square,
                              const Eight& distance, EightNearest& best, std::size_t n) {
  for (std::size_t l = 0; l < n; ++l) {
    const bool nearer = square[l] < best.square[l];
    best.square[l] = nearer ? square[l] : best.square[l];
    best.distance[l] = nearer ? distance[l] : best.distance[l];
    best.stretch[l] = nearer ? stretch : best.stretch[l];
    best.share[l] = nearer ? share : best.share[l];
  }
}

TUBECUT_INLINE double least_of(const Eight& of) {
  const auto less = [](double a, double b) { return a < b ? a : b; };
  return less(less(less(of[0], of[1]), less(of[2], of[3])),
              less(less(of[4], of[5]), less(of[6], of[7])));
}

TUBECUT_INLINE void roots(const Eight& of, Eight& out, std::size_t n) {
  for (std::size_t l = 0; l < n; ++l) out[l] = std::sqrt(of[l]);
}

/// Computes the fractions at which parabolas through three points are lowest; `promise` is below 0
/// if one is within the segment and may be nearer than the best.
TUBECUT_INLINE void bottoms(const Eight& low, const Eight& middle, const Eight& high,
                            const EightNearest& best, Eight& share, Eight& promise, std::size_t n) {
  for (std::size_t l = 0; l < n; ++l) {
    const double bend = low[l] - 2.0 * middle[l] + high[l], rise = high[l] - low[l];
    const double off = 0.25 * rise / (bend > kTiny ? bend : kTiny);
    const double lowest = middle[l] - 0.5 * rise * off;
    const bool within = (bend > kTiny) & (off < 0.5) & (off > -0.5);
    share[l] = within ? 0.5 - off : 0.5;
    promise[l] = within ? lowest * (1.0 - kParabola) - best.square[l] : 1.0;
  }
}

/// Refines from there to the nearest axis by Newton.
TUBECUT_INLINE void descend(const Way& way, double stretch, const EightPoints& points, Eight& x,
                            const Eight& promise, EightNearest& best, std::size_t n) {
  const Vector i0 = of(way.inner[0]), i1 = of(way.inner[1]), i2 = of(way.inner[2]);
  const Vector a0 = of(way.across[0]), a1 = of(way.across[1]), a2 = of(way.across[2]);
  const double floor = way.floor;
  alignas(64) Eight left_to_gain{};
  for (int k = 0; k < kSteps; ++k) {
    for (std::size_t l = 0; l < n; ++l) {
      const double at = x[l], twice = 2.0 * at;
      const Vector p = along(i0, at, along(i1, at, i2)), d = along(a0, at, along(a1, at, a2));
      const Vector p1 = along(i1, twice, i2), d1 = along(a1, twice, a2);
      const Vector off = from(p, {points.x[l], points.y[l], points.z[l]});
      const double inverse = 1.0 / dot(d, d), foot = dot(off, d) * inverse;
      const bool free = foot > floor;
      const double s = free ? foot : floor;
      const Vector left = along(off, -s, d), way1 = along(p1, s, d1);
      const double turn = free ? (dot(left, d1) - dot(way1, d)) * inverse : 0.0;  // of s
      const Vector bent = along(along({2.0 * i2.x, 2.0 * i2.y, 2.0 * i2.z}, 2.0 * s, a2), turn, d1);
      const double falls = dot(left, way1);
      const double bend = dot(along(way1, turn, d), way1) - dot(left, bent);
      const double to = at + falls / (bend > kTiny ? bend : kTiny);
      const double next = to < 0.0 ? 0.0 : to > 1.0 ? 1.0 : to;
      const double step = (promise[l] < 0.0) & (bend > kTiny) ? next - at : 0.0;
      const double square = dot(left, left);
      const bool nearer = square < best.square[l];
      best.square[l] = nearer ? square : best.square[l];
      best.stretch[l] = nearer ? stretch : best.stretch[l];
      best.share[l] = nearer ? at : best.share[l];
      x[l] = at + step;
      left_to_gain[l] = kGained * square - std::abs(step * falls);
    }
    if (least_of(left_to_gain) >= 0.0) break;
  }
  roots(best.square, best.distance, n);
}

TUBECUT_WIDE void squares_of(const AxisAt& axis, double floor, const EightPoints& points,
                             Eight& out, std::size_t packs) {
  const std::size_t n = kLanes * packs;
  alignas(64) Eight square{};
  all_squares(axis, floor, points, square, n);
  out = square;
}

TUBECUT_WIDE void see_all(double stretch, double share, const Eight& square, EightNearest& best,
                          std::size_t packs) {
  const std::size_t n = kLanes * packs;
  alignas(64) Eight distance{};
  roots(square, distance, n);
  take_less(stretch, share, square, distance, best, n);
}

TUBECUT_WIDE Walked walk_all(const Way& way, double stretch, bool ahead, double inner,
                             const EightPoints& points, Eight& near, EightNearest& best,
                             std::size_t packs) {
  const std::size_t n = kLanes * packs;
  const auto& to = ahead ? way.last : way.first;
  const double half = 0.5 * way.travel;
  alignas(64) Eight far{}, distance{}, slack{}, beside{};
  all_squares(to, way.floor, points, far, n);
  roots(far, distance, n);
  take_less(stretch, ahead ? 1.0 : 0.0, far, distance, best, n);
  for (std::size_t l = 0; l < n; ++l)
    slack[l] = 0.5 * (std::sqrt(near[l]) + distance[l]) - half - best.distance[l];
  if (least_of(slack) < 0.0) {
    alignas(64) Eight middle{}, share{}, promise{};
    all_squares(way.middle, way.floor, points, middle, n);
    if (ahead)
      bottoms(near, middle, far, best, share, promise, n);
    else
      bottoms(far, middle, near, best, share, promise, n);
    if (least_of(promise) < 0.0) {
      descend(way, stretch, points, share, promise, best, n);
    } else {
      roots(middle, slack, n);
      take_less(stretch, 0.5, middle, slack, best, n);
    }
  }
  const double x = to.p[0] / inner, y = to.p[1] / inner, side = ahead ? 1.0 : -1.0;
  for (std::size_t l = 0; l < n; ++l) {
    slack[l] = distance[l] - best.distance[l];
    beside[l] = side * (points.x[l] * y - points.y[l] * x) - best.distance[l];
  }
  near = far;
  const double clear = least_of(slack);
  return {clear > 0.0 ? clear : 0.0, least_of(beside)};
}

}  // namespace

void squares(const AxisAt& axis, double floor, const EightPoints& points, Eight& out) {
  squares_of(axis, floor, points, out, 1);
}

void see(double stretch, double share, const Eight& square, EightNearest& best) {
  see_all(stretch, share, square, best, 1);
}

Walked walk(const Way& way, double stretch, bool ahead, double inner, const EightPoints& points,
            Eight& near, EightNearest& best) {
  return walk_all(way, stretch, ahead, inner, points, near, best, 1);
}

}  // namespace tubecut::bevel::beam
