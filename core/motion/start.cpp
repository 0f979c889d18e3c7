// Start point, direction and sector of a track.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/elementary.hpp"
#include "core/motion/contour.hpp"

namespace tubecut::motion {
namespace {

constexpr double kSamePhi = 1e-9;  // rad; nearer than this a point is the asked one
constexpr double kFromJunction =
    5.0;  // mm that an automatic start keeps away from a corner, if it can
constexpr double kCornerCos = 0.93969262;  // cos 20 deg: beyond it two steps make a corner

ContourPoint between(const ContourPoint& a, const ContourPoint& b, double share) {
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  return {mix(a.phi, b.phi), mix(a.z, b.z), mix(a.b, b.b), false, mix(a.beam, b.beam)};
}

/// Makes point `first` of a closed track its start.
Track rotated(const Track& t, std::size_t first) {
  Track out = t;
  out.points.clear();
  const std::size_t n = t.points.size() - 1;
  for (std::size_t j = 0; j <= n; ++j) {
    ContourPoint p = t.points[(first + j) % n];
    if (first + j >= n) p.phi += kTwoPi * t.turns;
    out.points.push_back(p);
  }
  return out;
}

/// The first place of the track at angle `phi`, modulo whole turns: a point there, inserted if need
/// be.
std::optional<std::size_t> at_phi(Track& t, double phi) {
  for (std::size_t i = 0; i + 1 < t.points.size(); ++i) {
    const ContourPoint a = t.points[i];
    const ContourPoint b = t.points[i + 1];
    const double low = std::min(a.phi, b.phi);
    const double target = phi + kTwoPi * std::ceil((low - kSamePhi - phi) / kTwoPi);
    if (std::abs(target - a.phi) <= kSamePhi) return i;
    if (std::abs(target - b.phi) <= kSamePhi) return i + 1;
    if (target > std::max(a.phi, b.phi)) continue;
    const double share = (target - a.phi) / (b.phi - a.phi);
    t.points.insert(t.points.begin() + static_cast<std::ptrdiff_t>(i) + 1, between(a, b, share));
    return i + 1;
  }
  return std::nullopt;
}

bool is_corner(const Track& t, std::size_t i) {
  if (t.points[i].corner) return true;
  const std::size_t n = t.points.size() - 1;
  const ContourPoint& o = t.points[i];
  const ContourPoint& a = t.points[i == 0 ? n - 1 : i - 1];
  const ContourPoint& b = t.points[i + 1];
  const double wrap = i == 0 ? kTwoPi * t.turns : 0.0;
  const double ax = t.radius * (o.phi - a.phi + wrap), az = o.z - a.z, ab = 10.0 * (o.b - a.b);
  const double bx = t.radius * (b.phi - o.phi), bz = b.z - o.z, bb = 10.0 * (b.b - o.b);
  const double lengths = elementary::hypot(ax, az, ab) * elementary::hypot(bx, bz, bb);
  return ax * bx + az * bz + ab * bb < kCornerCos * lengths;
}

/// Distance along the track from each point to its nearest corner.
std::vector<double> from_corner(const Track& t) {
  const std::size_t n = t.points.size() - 1;
  std::vector<double> distance(n, 1e300);
  for (std::size_t i = 0; i < n; ++i) {
    if (is_corner(t, i)) distance[i] = 0.0;
  }
  for (std::size_t twice = 0; twice < 2; ++twice) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      distance[next] = std::min(distance[next], distance[i] + t.tip_step(i, i + 1));
    }
    for (std::size_t i = n; i-- > 0;) {
      distance[i] = std::min(distance[i], distance[(i + 1) % n] + t.tip_step(i, i + 1));
    }
  }
  return distance;
}

/// Least |B| among the points well away from corners; without such, the point farthest from them.
std::size_t automatic_start(const Track& t) {
  const std::vector<double> distance = from_corner(t);
  std::size_t best = 0;
  const auto better = [&](std::size_t a, std::size_t b) {
    const bool a_clear = distance[a] >= kFromJunction, b_clear = distance[b] >= kFromJunction;
    if (a_clear != b_clear) return a_clear;
    if (!a_clear) return distance[a] > distance[b];
    return std::abs(t.points[a].b) < std::abs(t.points[b].b);
  };
  for (std::size_t i = 1; i < distance.size(); ++i) {
    if (better(i, best)) best = i;
  }
  return best;
}

Track reversed(Track t) {
  std::ranges::reverse(t.points);
  t.turns = -t.turns;
  return t;
}

Result<Track> started(Track t, const Start& start) {
  if (start.at == Start::At::first_point) return t;
  if (!t.closed) {
    return fail({.code = ErrorCode::unsupported_combination, .member = "motion/start"});
  }
  if (start.at == Start::At::automatic) return rotated(t, automatic_start(t));
  const auto first = at_phi(t, start.phi.rad());
  if (!first) {
    return fail({ErrorCode::out_of_range,
                 "motion/start",
                 start.phi.deg(),
                 {},
                 "deg",
                 "the contour does not reach this angle"});
  }
  return rotated(t, *first % (t.points.size() - 1));
}

}  // namespace

std::vector<ContourPoint> first_stretch(const Track& t, double length) {
  std::vector<ContourPoint> out{t.points.front()};
  for (std::size_t i = 1; i < t.points.size() && length > 0.0; ++i) {
    const double step = t.tip_step(i - 1, i);
    const bool whole = step <= length;
    out.push_back(whole ? t.points[i] : between(t.points[i - 1], t.points[i], length / step));
    length -= step;
  }
  return out;
}

Result<Track> directed(Track t, const Motion& motion) {
  const bool turn = (motion.direction == Direction::ccw && t.orientation() < 0) ||
                    (motion.direction == Direction::cw && t.orientation() > 0);
  return started(turn ? reversed(std::move(t)) : std::move(t), motion.start);
}

Result<Track> sector_of(const Track& whole, const Sector& sector) {
  if (!whole.closed || whole.turns == 0) {
    return fail({.code = ErrorCode::unsupported_combination, .member = "motion/sector"});
  }
  Track t = whole;
  const auto from = at_phi(t, sector.from.rad());
  if (!from) return fail({.code = ErrorCode::out_of_range, .member = "motion/sector/from"});
  t = rotated(t, *from % (t.points.size() - 1));
  const double turn = whole.turns * (sector.to - sector.from).rad();
  const double span = turn - kTwoPi * std::floor(turn / kTwoPi);
  Track cut = t;
  const auto to = at_phi(cut, t.points.front().phi + whole.turns * span);
  if (!to || *to == 0) {
    return fail({ErrorCode::out_of_range, "motion/sector/to", sector.to.deg(), {}, "deg", {}});
  }
  cut.points.resize(*to + 1);
  std::vector<ContourPoint> before = first_stretch(reversed(t), std::max(0.0, sector.back_up));
  for (auto p = before.begin() + 1; p != before.end(); ++p) {
    p->phi -= kTwoPi * whole.turns;
    cut.points.insert(cut.points.begin(), *p);
  }
  cut.closed = false;
  cut.turns = 0;
  return cut;
}

}  // namespace tubecut::motion
