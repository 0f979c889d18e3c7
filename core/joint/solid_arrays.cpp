#include "core/joint/solid_arrays.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/lanes.hpp"

namespace tubecut::joint {
namespace {

/// The numbers of a tube, for loops.
struct Tube {
  double px, py, pz, dx, dy, dz, radius;

  explicit Tube(const TubeSolid& t)
      : px(t.point.x()),
        py(t.point.y()),
        pz(t.point.z()),
        dx(t.direction.x()),
        dy(t.direction.y()),
        dz(t.direction.z()),
        radius(t.radius) {}

  [[nodiscard]] double distance(double x, double y, double z) const {
    const double ax = x - px, ay = y - py, az = z - pz;
    const double cx = ay * dz - az * dy, cy = az * dx - ax * dz, cz = ax * dy - ay * dx;
    return std::sqrt(cx * cx + cy * cy + cz * cz) - radius;
  }
};

struct From {
  const double *x, *y, *z;
  std::size_t n;
};
From from_all(const PointArrays& p) { return {p.x.data(), p.y.data(), p.z.data(), p.size()}; }

struct To {
  double *x, *y, *z;
};

TUBECUT_WIDE void tube_normals(const Tube& tube, From at, To out) {
  const auto t = tube;
  for (std::size_t i = 0; i < at.n; ++i) {
    const double ax = at.x[i] - t.px, ay = at.y[i] - t.py, az = at.z[i] - t.pz;
    const double along = ax * t.dx + ay * t.dy + az * t.dz;
    const double nx = ax - along * t.dx, ny = ay - along * t.dy, nz = az - along * t.dz;
    const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
    const double unit = length > 0.0 ? length : 1.0;
    out.x[i] = nx / unit;
    out.y[i] = ny / unit;
    out.z[i] = nz / unit;
  }
}

TUBECUT_WIDE void tube_distances(const Tube& tube, From at, double* out) {
  const auto t = tube;
  for (std::size_t i = 0; i < at.n; ++i) out[i] = t.distance(at.x[i], at.y[i], at.z[i]);
}

/// Same as TubeSolid::least_distance: the parabola through the squares of three distances.
TUBECUT_WIDE void tube_least(const Tube& tube, From a, From b, double* out) {
  const auto t = tube;
  for (std::size_t i = 0; i < a.n; ++i) {
    const double ax = a.x[i], ay = a.y[i], az = a.z[i], bx = b.x[i], by = b.y[i], bz = b.z[i];
    const double first = t.distance(ax, ay, az), last = t.distance(bx, by, bz);
    const double half = t.distance(0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz));
    const auto square = [&](double d) { return (d + t.radius) * (d + t.radius); };
    const double low = square(first), mid = square(half), high = square(last);
    const double bend = 2.0 * (low - 2.0 * mid + high);
    const double apex = (3.0 * low - 4.0 * mid + high) / (2.0 * bend);
    const double share = std::max(0.0, std::min(1.0, apex));
    const double there =
        t.distance(ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az));
    const double least = std::min(std::min(first, half), last);
    out[i] = ((t.radius > 0.0) & (bend > 0.0)) ? std::min(least, there) : least;
  }
}

TUBECUT_WIDE void lower_all(double* least, const double* other, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    least[i] = ((other[i] < least[i]) | (other[i] != other[i])) ? other[i] : least[i];
}

TUBECUT_WIDE void tube_nearest(const Tube& tube, From a, From b, double* share, double* distance) {
  const auto t = tube;
  for (std::size_t i = 0; i < a.n; ++i) {
    const double ax = a.x[i], ay = a.y[i], az = a.z[i];
    const double wx = b.x[i] - ax, wy = b.y[i] - ay, wz = b.z[i] - az;
    const double along = wx * t.dx + wy * t.dy + wz * t.dz;
    const double cx = wx - along * t.dx, cy = wy - along * t.dy, cz = wz - along * t.dz;
    const double square = cx * cx + cy * cy + cz * cz;
    const double to = ((t.px - ax) * cx + (t.py - ay) * cy + (t.pz - az) * cz) / square;
    const double s = square > 0.0 ? std::max(0.0, std::min(1.0, to)) : 0.0;
    share[i] = s;
    distance[i] = t.distance(ax + s * wx, ay + s * wy, az + s * wz);
  }
}

}  // namespace

void distances(const Solid& solid, const PointArrays& places, std::span<double> out) {
  if (const auto* tube = std::get_if<TubeSolid>(&solid.kind()))
    return tube_distances(Tube(*tube), from_all(places), out.data());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = solid.distance(places.at(i));
}

void least_distances(const Solid& solid, const PointArrays& from, const PointArrays& to,
                     std::span<double> out) {
  if (const auto* tube = std::get_if<TubeSolid>(&solid.kind()))
    return tube_least(Tube(*tube), from_all(from), from_all(to), out.data());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = solid.least_distance(from.at(i), to.at(i));
}

void normals(const Solid& solid, const PointArrays& places, std::size_t from, std::size_t to,
             PointArrays& out) {
  if (const auto* tube = std::get_if<TubeSolid>(&solid.kind()))
    return tube_normals(
        Tube(*tube),
        {places.x.data() + from, places.y.data() + from, places.z.data() + from, to - from},
        {out.x.data() + from, out.y.data() + from, out.z.data() + from});
  for (std::size_t i = from; i < to; ++i) out.set(i, solid.normal(places.at(i)));
}

void lower(std::span<double> least, std::span<const double> other) {
  lower_all(least.data(), other.data(), least.size());
}

void nearest_on_ways(const TubeSolid& solid, const PointArrays& from, const PointArrays& to,
                     std::span<double> share, std::span<double> distance) {
  tube_nearest(Tube(solid), from_all(from), from_all(to), share.data(), distance.data());
}

}  // namespace tubecut::joint
