#include "core/motion/edges.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

constexpr std::size_t kPerKnot = 4;
constexpr double kNear = 1.0;  // mm of generalised length either way: points of a corner cut off

/// A point of one wall, developed.
struct Flat {
  double s = 0.0, z = 0.0;
};

double distance(Flat p, Flat a, Flat b) {
  const double s = b.s - a.s, z = b.z - a.z, square = s * s + z * z;
  const double along = square > 0.0 ? ((p.s - a.s) * s + (p.z - a.z) * z) / square : 0.0;
  const double share = std::clamp(along, 0.0, 1.0);
  return elementary::hypot(p.s - a.s - share * s, p.z - a.z - share * z);
}

/// The beam's traces on both walls.
class Walls {
 public:
  explicit Walls(const Contour& contour, double sigma)
      : radius_{contour.outer_radius, contour.inner_radius()} {
    for (std::size_t w = 0; w < 2; ++w) rise_[w] = sigma * (radius_[w] - contour.radius());
  }
  [[nodiscard]] std::array<Flat, 2> at(double phi, double z, double b) const {
    const double tan = elementary::tan(b);
    return {Flat{radius_[0] * phi, z - rise_[0] * tan}, Flat{radius_[1] * phi, z - rise_[1] * tan}};
  }

 private:
  std::array<double, 2> radius_;
  std::array<double, 2> rise_{};
};

}  // namespace

std::optional<EdgeDeviation> edge_deviation(const ScheduleSpec& spec, const Program& program,
                                            const Path& path, const std::stop_token& stop) {
  const auto* const contour = std::get_if<Contour>(&spec.cut);
  if (contour == nullptr) return std::nullopt;
  const Walls walls(*contour, spec.machine.sigma());
  std::vector<std::array<Flat, 2>> points;
  for (std::size_t i = 0; i < program.size(); ++i)
    points.push_back(walls.at(program.x[0][i], program.x[1][i], program.x[2][i]));
  const auto& at = path.at_point;
  const double from = at[program.cut_first], to = at[program.cut_last];
  std::array<double, 2> most{};
  /// Least distance on one wall to the segments near `u`; own one first, for it mostly suffices.
  const auto off = [&](Flat here, std::size_t wall, std::size_t own, double u) {
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
    if (k % 4096 == 0 && stop.stop_requested()) return std::nullopt;
    const double offset = path.d * static_cast<double>(k % kPerKnot) / kPerKnot;
    const double u = path.d * static_cast<double>(k / kPerKnot) + offset;
    if (u < from || u > to) continue;
    while (own + 1 < program.cut_last && at[own + 1] <= u) ++own;
    const auto x = cursor.at(k / kPerKnot, offset).x;
    const auto here = walls.at(x[0], x[1], x[2]);
    for (std::size_t w = 0; w < 2; ++w) most[w] = std::max(most[w], off(here[w], w, own, u));
  }
  return EdgeDeviation{.outer = most[0], .inner = most[1]};
}

}  // namespace tubecut::motion
