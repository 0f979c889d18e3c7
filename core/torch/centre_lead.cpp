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
  [[nodiscard]] bool is_corner(std::size_t i) const {
    constexpr double kStraight = 0.94;  // cos 20 deg
    const Way before = at(i) - at(i + size() - 1), after = at(i + 1) - at(i);
    return before.dot(after) < kStraight * before.norm() * after.norm();
  }

 private:
  const motion::Track& track_;
};

/// How far the way from the centre to a point is from square to the cut, 0 to 1.
double off_square(const Loop& loop, std::size_t i, const Way& centre) {
  return std::abs((loop.at(i) - centre).normalized().dot(loop.along(i)));
}

/// A place of the cut: on the piece from this point to the next.
struct Foot {
  std::size_t piece = 0;
  double share = 0.0;
};

/// Returns the nearest place to which the way from the centre is square: a point, or the foot on a
/// long straight piece, because a window has rows at its corners only. Not the farthest end of a
/// slot, to which the way is square too. Without one, the point that is nearest to square.
Foot nearest_square(const Loop& loop, const Way& centre) {
  constexpr double kSkew = 0.05;  // more than rows of an arc have
  constexpr double kEnds = 0.1;   // of a piece at a corner, where no cut begins
  constexpr double kSame = 1e-6;  // mm; nearer to a point, the place is that point by rounding
  Foot best, squarest;
  double nearest = std::numeric_limits<double>::infinity(), least = 2.0;
  const auto take = [&](std::size_t i, double share, const Way& at) {
    if (const double far = (at - centre).norm(); far < nearest) {
      nearest = far;
      best = {i, share};
    }
  };
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double off = off_square(loop, i, centre);
    if (off <= kSkew && !loop.is_corner(i)) take(i, 0.0, loop.at(i));
    if (off < least) {
      least = off;
      squarest = {i, 0.0};
    }
    const Way piece = loop.at(i + 1) - loop.at(i);
    const double share = (centre - loop.at(i)).dot(piece) / piece.squaredNorm();
    const double same = kSame / piece.norm();
    const double first = loop.is_corner(i) ? kEnds : same;
    const double last = 1.0 - (loop.is_corner(i + 1) ? kEnds : same);
    if (piece.norm() >= kLeastArc && share > first && share < last)
      take(i, share, loop.at(i) + share * piece);
  }
  return std::isfinite(nearest) ? best : squarest;
}

/// Returns the point at a share of the way between two.
motion::CutPoint between(const motion::CutPoint& from, const motion::CutPoint& to, double share) {
  auto out = from;
  out.phi += share * (to.phi - from.phi);
  out.z += share * (to.z - from.z);
  out.b += share * (to.b - from.b);
  out.a += share * (to.a - from.a);
  out.corner = false;
  return out;
}

/// Returns the index of the foot, which is inserted if it is no point of the track.
std::size_t put_in(const Foot& foot, motion::Track& track) {
  if (foot.share == 0.0) return foot.piece;
  const auto point = between(track.points[foot.piece], track.points[foot.piece + 1], foot.share);
  track.points.insert(track.points.begin() + static_cast<std::ptrdiff_t>(foot.piece + 1), point);
  return foot.piece + 1;
}

}  // namespace

Result<motion::CutWithLead> centre_lead(const TorchCut& cut, double overcut, CentreWay way) {
  TRY(auto track, motion::track(motion::without_repeats(cut.path)));
  const Way centre(track.radius * cut.centre->phi, cut.centre->z);
  const auto first = put_in(nearest_square(Loop(track), centre), track);
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
  if (way == CentreWay::straight || onto.norm() < kLeastArc) {
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
    const auto &from = loop.point(first + i), &to = loop.point(first + i + 1);
    out.points.push_back(step > left ? between(from, to, left / step) : to);
    left -= step;
  }
  out.cut_last = out.points.size() - 1;
  return out;
}

TorchCut with_middles(TorchCut cut) {
  constexpr double kLong = 2.0;  // mm
  const auto column = [&](const std::vector<double>& of, std::size_t i) {
    return 0.5 * (of[i] + of[i + 1]);
  };
  auto& path = cut.path;
  for (std::size_t i = path.phi.size() - 1; i-- > 0;) {
    const double round = path.outer_radius * (path.phi[i + 1] - path.phi[i]);
    if (elementary::hypot(round, path.z[i + 1] - path.z[i]) < kLong) continue;
    const auto at = static_cast<std::ptrdiff_t>(i + 1);
    for (auto* of : {&path.phi, &path.z, &path.b, &path.a})
      if (!of->empty()) of->insert(of->begin() + at, column(*of, i));
    if (!path.corner.empty()) path.corner.insert(path.corner.begin() + at, false);
  }
  return cut;
}

}  // namespace tubecut::torch
