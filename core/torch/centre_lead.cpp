#include "core/torch/centre_lead.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"

namespace tubecut::torch {
namespace {

constexpr double kLeastArc = 1.0;  // mm from the centre to the cut, below it the way is straight
constexpr int kParts = 16;         // of a half circle

using Way = Eigen::Vector2d;  // on the developed outside, mm

double cross(const Way& a, const Way& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The closed track on the developed outside, with its first point once.
class Loop {
 public:
  explicit Loop(const motion::Track& track) : track_(track) {}

  [[nodiscard]] std::size_t size() const { return track_.points.size() - 1; }
  [[nodiscard]] const motion::CutPoint& point(std::size_t i) const {
    return track_.points[i % size()];
  }
  [[nodiscard]] Way at(std::size_t i) const { return {track_.radius * point(i).phi, point(i).z}; }
  [[nodiscard]] Way along(std::size_t i) const {
    return (at(i + 1) - at(i + size() - 1)).normalized();
  }
  /// Where the way from the centre is nearest to square to the cut.
  [[nodiscard]] std::size_t squarest(const Way& centre) const {
    std::size_t best = 0;
    double least = 2.0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double off = std::abs((at(i) - centre).normalized().dot(along(i)));
      if (off < least - 1e-6) {
        least = off;
        best = i;
      }
    }
    return best;
  }

 private:
  const motion::Track& track_;
};

/// How far the way from the centre to a point is from square to the cut, 0 to 1.
double off_square(const Loop& loop, std::size_t i, const Way& centre) {
  return std::abs((loop.at(i) - centre).normalized().dot(loop.along(i)));
}

/// Inserts the point nearest to the centre on a long straight piece, because a window has rows at
/// its corners only; returns its index.
std::optional<std::size_t> add_foot(const Way& centre, motion::Track& track) {
  constexpr double kEnds = 0.1;  // of a piece, where no cut begins
  const Loop loop(track);
  std::optional<std::size_t> best;
  double nearest = std::numeric_limits<double>::infinity(), at = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Way piece = loop.at(i + 1) - loop.at(i);
    const double share = (centre - loop.at(i)).dot(piece) / piece.squaredNorm();
    const double far = (loop.at(i) + share * piece - centre).norm();
    if (piece.norm() < kLeastArc || !(share > kEnds && share < 1.0 - kEnds) || far >= nearest)
      continue;
    nearest = far;
    best = i;
    at = share;
  }
  if (!best) return best;
  const auto &from = track.points[*best], &to = track.points[*best + 1];
  auto foot = from;
  foot.phi += at * (to.phi - from.phi);
  foot.z += at * (to.z - from.z);
  foot.b += at * (to.b - from.b);
  foot.a += at * (to.a - from.a);
  foot.corner = false;
  track.points.insert(track.points.begin() + static_cast<std::ptrdiff_t>(*best + 1), foot);
  return *best + 1;
}

}  // namespace

Result<motion::CutWithLead> centre_lead(const TorchCut& cut, double overcut) {
  constexpr double kSkew = 0.05;  // of the way onto the cut, more than rows of an arc have
  TRY(auto track, motion::track(motion::without_repeats(cut.path)));
  const Way centre(track.radius * cut.centre->phi, cut.centre->z);
  auto first = Loop(track).squarest(centre);
  if (off_square(Loop(track), first, centre) > kSkew)
    first = add_foot(centre, track).value_or(first);
  const Loop loop(track);
  const Way onto = loop.at(first) - centre;
  motion::CutWithLead out;
  const auto lead_point = [&](const Way& p) {
    auto point = loop.point(first);
    point.phi = p.x() / track.radius;
    point.z = p.y();
    point.corner = false;
    out.points.push_back(point);
  };
  if (onto.norm() < kLeastArc) {
    lead_point(centre);
  } else {
    const double sign = std::copysign(1.0, cross(onto, loop.along(first)));
    for (int i = 0; i < kParts; ++i) {
      const auto [sin, cos] = elementary::sincos(sign * kPi * i / kParts);
      const Way arm = -0.5 * onto;
      lead_point(centre + 0.5 * onto +
                 Way(cos * arm.x() - sin * arm.y(), sin * arm.x() + cos * arm.y()));
    }
  }
  out.cut_first = out.points.size();
  for (std::size_t i = 0; i <= loop.size(); ++i) out.points.push_back(loop.point(first + i));
  double left = overcut;
  for (std::size_t i = 0; left > 0.0 && i < loop.size(); ++i) {
    const double step = (loop.at(first + i + 1) - loop.at(first + i)).norm();
    auto point = loop.point(first + i + 1);
    if (step > left) {
      const double share = left / step;
      const auto& from = loop.point(first + i);
      point.phi = from.phi + share * (point.phi - from.phi);
      point.z = from.z + share * (point.z - from.z);
      point.a = from.a + share * (point.a - from.a);
      point.corner = false;
    }
    out.points.push_back(point);
    left -= step;
  }
  out.cut_last = out.points.size() - 1;
  return out;
}

}  // namespace tubecut::torch
