#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/motion/path/chords.hpp"
#include "core/motion/path/course.hpp"
#include "core/motion/path/upright.hpp"
#include "core/motion/schedule/report.hpp"

namespace tubecut::motion {
namespace {

constexpr std::size_t kPerKnot = 4;
constexpr double kNear =
    1.0;  // mm of generalised length in each direction, because corners may be cut off

/// The beam's traces on both walls of a round tube, each developed.
class Walls {
 public:
  using Point = Flat;
  explicit Walls(const CutPath& cut_path, double sigma)
      : radius_{cut_path.outer_radius, cut_path.inner_radius()} {
    for (std::size_t w = 0; w < 2; ++w) rise_[w] = sigma * (radius_[w] - cut_path.radius());
  }
  [[nodiscard]] std::array<Flat, 2> at(const Coordinates& x) const {
    const double phi = x[0], z = x[1];
    const double tan = elementary::tan(x[2]);
    return {Flat{radius_[0] * phi, z - rise_[0] * tan}, Flat{radius_[1] * phi, z - rise_[1] * tan}};
  }

 private:
  std::array<double, 2> radius_;
  std::array<double, 2> rise_{};
};

/// A point in space.
using Spot = std::array<double, 3>;

double distance(const Spot& p, const Spot& a, const Spot& b) {
  double along = 0.0, square = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    along += (p[c] - a[c]) * (b[c] - a[c]);
    square += (b[c] - a[c]) * (b[c] - a[c]);
  }
  const double share = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  Spot off{};
  for (std::size_t c = 0; c < 3; ++c) off[c] = p[c] - a[c] - share * (b[c] - a[c]);
  return elementary::hypot(off[0], off[1], off[2]);
}

/// The beam's traces on the outside of a section and at its thickest wall's depth below it.
class SectionWalls {
 public:
  using Point = Spot;
  explicit SectionWalls(const CutPath& cut_path, double sigma)
      : wall_(cut_path.wall), sigma_(sigma) {}
  [[nodiscard]] std::array<Spot, 2> at(const Coordinates& x) const {
    const auto [sin, cos] = elementary::sincos(x[0]);
    const double rise = sigma_ * wall_ * elementary::tan(x[2]);
    return {Spot{x[3], x[4], x[1]}, Spot{x[3] - wall_ * cos, x[4] - wall_ * sin, x[1] + rise}};
  }

 private:
  double wall_, sigma_;
};

template <class Traces>
std::optional<EdgeDeviation> farthest(const Traces& walls, const Program& program,
                                      const Path& path) {
  using Point = typename Traces::Point;
  std::vector<std::array<Point, 2>> points;
  for (std::size_t i = 0; i < program.size(); ++i)
    points.push_back(walls.at(coordinates_of(program, i)));
  const auto& at = path.at_point;
  const double from = at[program.cut_first], to = at[program.cut_last];
  std::array<double, 2> most{};
  /// Finds the smallest distance on one wall to the segments near `u`; the own segment first,
  /// because it usually suffices.
  const auto off = [&](const Point& here, std::size_t wall, std::size_t own, double u) {
    const auto to_segment = [&](std::size_t i) {
      return distance(here, points[i][wall], points[i + 1][wall]);
    };
    double least = to_segment(own);
    for (auto i = own; i-- > program.cut_first && at[i + 1] > u - kNear && least > most[wall];)
      least = std::min(least, to_segment(i));
    for (auto i = own + 1; i < program.cut_last && at[i] < u + kNear && least > most[wall]; ++i)
      least = std::min(least, to_segment(i));
    return least;
  };
  std::size_t own = program.cut_first;
  PathCursor cursor(path, false);
  for (std::size_t k = 0; k < kPerKnot * path.intervals(); ++k) {
    if (k % 4096 == 0 && stopped()) return std::nullopt;
    const double offset = path.d * static_cast<double>(k % kPerKnot) / kPerKnot;
    const double u = path.d * static_cast<double>(k / kPerKnot) + offset;
    if (u < from || u > to) continue;
    while (own + 1 < program.cut_last && at[own + 1] <= u) ++own;
    const auto here = walls.at(cursor.at(k / kPerKnot, offset).x);
    for (std::size_t w = 0; w < 2; ++w) most[w] = std::max(most[w], off(here[w], w, own, u));
  }
  return EdgeDeviation{.outer = most[0], .inner = most[1]};
}

}  // namespace

std::optional<EdgeDeviation> edge_deviation(const ScheduleSpec& spec, const Program& program,
                                            const Path& path) {
  const auto* const cut_path = std::get_if<CutPath>(&spec.cut);
  if (cut_path == nullptr) return std::nullopt;
  const double sigma = spec.machine.sigma();
  if (cut_path->section) return farthest(SectionWalls(*cut_path, sigma), program, path);
  return farthest(Walls(*cut_path, sigma), program, path);
}

std::optional<double> largest_lean(const ScheduleSpec& spec, const Path& path) {
  const auto* const cut_path = std::get_if<CutPath>(&spec.cut);
  if (cut_path == nullptr || !cut_path->section) return std::nullopt;
  double most = 0.0;
  PathCursor cursor(path, false);
  for (std::size_t i = 0; i < path.intervals() && !stopped(); ++i) {
    const Coordinates x = cursor.at(i, 0.0).x;
    const double normal =
        cut_path->still ? *cut_path->still : normal_towards(*cut_path->section, {x[3], x[4]});
    most = std::max(most, std::abs(std::remainder(x[0] - normal, kTwoPi)));
  }
  return most;
}

}  // namespace tubecut::motion
