#include "core/motion/path/cut_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/automatic_start.hpp"
#include "core/motion/path/stretch.hpp"

namespace tubecut::motion {
namespace {

constexpr double kBack = 3e-3;     // rad, of a reversal
constexpr double kClosing = 1e-6;  // mm and rad between the two ends
constexpr double kMostBevel = 85.0 * kRadPerDeg + 1e-12;
constexpr double kMostPhi =
    72000.0 * kRadPerDeg;            // because phi of a program accumulates from cut to cut
constexpr double kMostLength = 1e6;  // mm

Result<void> check_columns(const CutPath& c) {
  const std::size_t n = c.phi.size();
  if (n < 3) {
    return fail({ErrorCode::wrong_count, "contour/phi", static_cast<double>(n), 3.0, {}, {}});
  }
  const auto wrong = [&](const char* column, std::size_t got) {
    return fail({.code = ErrorCode::wrong_count,
                 .member = std::string("contour/") + column,
                 .got = static_cast<double>(got),
                 .limit = static_cast<double>(n),
                 .hint = "as many as phi has: " + std::to_string(n)});
  };
  if (c.z.size() != n) return wrong("z", c.z.size());
  if (c.b.size() != n) return wrong("b", c.b.size());
  if (!c.corner.empty() && c.corner.size() != n) return wrong("corner", c.corner.size());
  if (!c.beam.empty() && c.beam.size() != n) return wrong("beam", c.beam.size());
  if (!c.a.empty() && c.a.size() != n) return wrong("a", c.a.size());
  if (!(c.outer_radius > 0.0 && c.outer_radius < kMostLength)) {
    return fail({.code = ErrorCode::bad_number, .member = "contour/outer_radius"});
  }
  if (!(c.wall >= 0.0 && c.wall < c.outer_radius)) {
    return fail({.code = ErrorCode::bad_number, .member = "contour/wall"});
  }
  return {};
}

std::string member(const char* column, std::size_t i) {
  return std::string("contour/") + column + "/" + std::to_string(i);
}

Result<void> check_numbers(const CutPath& c) {
  for (std::size_t i = 0; i < c.phi.size(); ++i) {
    if (!(std::abs(c.phi[i]) <= kMostPhi)) {
      return fail({.code = ErrorCode::bad_number, .member = member("phi", i)});
    }
    if (!(std::abs(c.z[i]) <= kMostLength)) {
      return fail({.code = ErrorCode::bad_number, .member = member("z", i)});
    }
    if (!std::isfinite(c.b[i])) {
      return fail({.code = ErrorCode::bad_number, .member = member("b", i)});
    }
    if (std::abs(c.b[i]) > kMostBevel) {
      return fail(
          {ErrorCode::angle_out_of_range, member("b", i), c.b[i] * kDegPerRad, 85.0, "deg", {}});
    }
    if (!c.a.empty() && !(std::abs(c.a[i]) < 0.5 * kPi)) {
      return fail({.code = ErrorCode::bad_number, .member = member("a", i)});
    }
    if (!c.beam.empty() && !(c.beam[i] >= 0.0 && c.beam[i] <= kMostLength)) {
      return fail({.code = ErrorCode::bad_number, .member = member("beam", i)});
    }
  }
  return {};
}

std::vector<CutPoint> rows(const CutPath& c) {
  std::vector<CutPoint> points;
  points.reserve(c.phi.size() + 1);  // the closing point
  for (std::size_t i = 0; i < c.phi.size(); ++i) {
    const double beam = c.beam.empty() ? c.wall / elementary::cos(c.b[i]) : c.beam[i];
    points.push_back({c.phi[i], c.z[i], c.b[i], !c.corner.empty() && c.corner[i], beam,
                      c.a.empty() ? 0.0 : c.a[i]});
  }
  return points;
}

bool agree(const CutPoint& a, const CutPoint& b) {
  return std::abs(a.z - b.z) <= kClosing && std::abs(a.b - b.b) <= kClosing;
}

double largest_phi_step(const std::vector<CutPoint>& points) {
  double largest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    largest = std::max(largest, std::abs(points[i].phi - points[i - 1].phi));
  }
  return largest;
}

constexpr double kSamePhi = 1e-9;  // rad; a nearer point is used as the requested one
constexpr double kSteepest = 1e3;  // slope of a curve on the tube

/// Sets the end to the first point one revolution on, and appends it if a whole revolution is open;
/// `gap` is the missing rad of phi.
Result<void> close(Track& t, double gap) {
  auto& points = t.points;
  const bool near = std::abs(gap) <= kClosing;
  const bool there = near && agree(points.front(), points.back());
  // A corner of the curve may lie that near before the first row; on it a torch's line is steep.
  const double rise = std::abs(points.back().z - points.front().z);
  const bool before = t.turns != 0 && gap > kSamePhi &&
                      (points.back().corner || rise <= kSteepest * t.radius * gap);
  if (near && !there && !before) {
    return fail({ErrorCode::not_closed, "contour", points.back().z - points.front().z, kClosing,
                 "mm", "the ends differ in z or b"});
  }
  const double most = t.turns == 0 ? 0.0 : 3.0 * largest_phi_step(points);
  if (!there && (gap < -kClosing || gap > most + kClosing)) {
    return fail({ErrorCode::not_closed, "contour", gap * kDegPerRad, 0.0, "deg",
                 "phi misses the whole turn by this"});
  }
  CutPoint end = points.front();
  end.phi += kTwoPi * t.turns;
  if (there) {
    points.back() = end;
  } else {
    points.push_back(end);
  }
  return {};
}

Result<void> close(Track& t, Scrap scrap) {
  const double span = t.points.back().phi - t.points.front().phi;
  if (scrap == Scrap::inside) {
    t.turns = 0;
    return close(t, std::abs(span));
  }
  t.turns = span < 0.0 ? -1 : 1;
  return close(t, kTwoPi - std::abs(span));
}

Result<void> check_duplicates(const Track& t) {
  for (std::size_t i = 1; i < t.points.size(); ++i) {
    const CutPoint& a = t.points[i - 1];
    const CutPoint& b = t.points[i];
    if (a.phi == b.phi && a.z == b.z && a.b == b.b && a.a == b.a) {
      return fail(
          {ErrorCode::duplicate_point, member("phi", i), a.phi * kDegPerRad, {}, "deg", {}});
    }
  }
  return {};
}

/// Rejects a track that runs straight back over itself, because the tip's position then does not
/// determine the position along the track.
Result<void> check_turns(const Track& t) {
  struct Way {
    double x, z;
    std::size_t from;
  };
  std::vector<Way> ways;  // of the tip: a swing without motion has none
  for (std::size_t i = 1; i < t.points.size(); ++i) {
    const CutPoint& a = t.points[i - 1];
    const CutPoint& b = t.points[i];
    if (a.phi != b.phi || a.z != b.z)
      ways.push_back({t.radius * (b.phi - a.phi), b.z - a.z, i - 1});
  }
  for (std::size_t k = t.closed ? 0 : 1; k < ways.size(); ++k) {  // if closed: across the join too
    const Way& there = ways[(k + ways.size() - 1) % ways.size()];
    const Way& on = ways[k];
    const double along = there.x * on.x + there.z * on.z;
    if (along < 0.0 && std::abs(there.x * on.z - there.z * on.x) <= kBack * -along)
      return fail({.code = ErrorCode::turns_back,
                   .member = member("phi", on.from),
                   .got = t.points[on.from].phi * kDegPerRad,
                   .unit = "deg"});
  }
  return {};
}

constexpr double kCornerCos = 0.93969262;  // cos 20 deg: beyond it two steps make a corner

/// Rotates a closed track so that point `first` is its start.
Track rotated(const Track& t, std::size_t first) {
  Track out = t;
  out.points.clear();
  const std::size_t n = t.points.size() - 1;
  for (std::size_t j = 0; j <= n; ++j) {
    CutPoint p = t.points[(first + j) % n];
    if (first + j >= n) p.phi += kTwoPi * t.turns;
    out.points.push_back(p);
  }
  return out;
}

/// Returns the first point of the track at angle `phi`, modulo whole revolutions; inserts one if
/// needed.
std::optional<std::size_t> at_phi(Track& t, double phi) {
  for (std::size_t i = 0; i + 1 < t.points.size(); ++i) {
    const CutPoint a = t.points[i];
    const CutPoint b = t.points[i + 1];
    const double low = std::min(a.phi, b.phi);
    const double target = phi + kTwoPi * std::ceil((low - kSamePhi - phi) / kTwoPi);
    if (std::abs(target - a.phi) <= kSamePhi) return i;
    if (std::abs(target - b.phi) <= kSamePhi) return i + 1;
    if (target > std::max(a.phi, b.phi)) continue;
    const double share = (target - a.phi) / (b.phi - a.phi);
    t.points.insert(t.points.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                    between(t.wall, a, b, share));
    return i + 1;
  }
  return std::nullopt;
}

bool is_corner(const Track& t, std::size_t i) {
  if (t.points[i].corner) return true;
  const std::size_t n = t.points.size() - 1;
  const CutPoint& o = t.points[i];
  const CutPoint& a = t.points[i == 0 ? n - 1 : i - 1];
  const CutPoint& b = t.points[i + 1];
  const double wrap = i == 0 ? kTwoPi * t.turns : 0.0;
  const double ax = t.radius * (o.phi - a.phi + wrap), az = o.z - a.z, ab = 10.0 * (o.b - a.b);
  const double bx = t.radius * (b.phi - o.phi), bz = b.z - o.z, bb = 10.0 * (b.b - o.b);
  const double lengths = elementary::hypot(ax, az, ab) * elementary::hypot(bx, bz, bb);
  return ax * bx + az * bz + ab * bb < kCornerCos * lengths;
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
  if (start.at == Start::At::automatic) return rotated(t, automatic_start(t, start.seam));
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

double Track::tip_step(std::size_t from, std::size_t to) const {
  return elementary::hypot(radius * (points[to].phi - points[from].phi),
                           points[to].z - points[from].z);
}

int Track::orientation() const {
  if (turns != 0) return turns;
  if (!closed) return points.back().phi < points.front().phi ? -1 : 1;
  double twice_area = 0.0;
  const CutPoint& o = points.front();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const CutPoint& a = points[i - 1];
    const CutPoint& b = points[i];
    twice_area += (a.phi - o.phi) * (b.z - o.z) - (b.phi - o.phi) * (a.z - o.z);
  }
  return twice_area < 0.0 ? -1 : 1;
}

Result<Track> track(const CutPath& cut_path) {
  TRY(check_columns(cut_path));
  TRY(check_numbers(cut_path));
  Track t{rows(cut_path), cut_path.radius(), cut_path.closed, 0};
  t.section = cut_path.section;
  t.still = cut_path.still;
  if (cut_path.surface == Surface::outer) t.wall = {cut_path.outer_radius, cut_path.inner_radius()};
  if (t.closed) TRY(close(t, cut_path.scrap));
  TRY(check_duplicates(t));
  TRY(check_turns(t));
  return t;
}

CutPath as_machine_counts(CutPath cut_path, BPositive b_positive) {
  if (b_positive == BPositive::outer_edge_to_waste) {
    for (double& b : cut_path.b) b = -b;
  }
  return cut_path;
}

CutPath turned_on(CutPath path, double turns) {
  for (double& phi : path.phi) phi += turns;
  if (path.still) *path.still += turns;
  return path;
}

CutPath without_repeats(CutPath c) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < c.phi.size(); ++i)
    if (i == 0 || c.phi[i] != c.phi[i - 1] || c.z[i] != c.z[i - 1] || c.b[i] != c.b[i - 1] ||
        (!c.a.empty() && c.a[i] != c.a[i - 1]))
      rows.push_back(i);
  if (rows.size() == c.phi.size()) return c;
  std::vector<bool> corner(c.corner.empty() ? 0 : rows.size(), false);
  for (std::size_t i = 0, k = 0; i < c.corner.size(); ++i) {
    while (k + 1 < rows.size() && rows[k + 1] <= i) ++k;
    if (c.corner[i]) corner[k] = true;
  }
  c.corner = std::move(corner);
  for (auto* column : {&c.phi, &c.z, &c.b, &c.a, &c.beam}) {
    if (column->empty()) continue;
    for (std::size_t k = 0; k < rows.size(); ++k) (*column)[k] = (*column)[rows[k]];
    column->resize(rows.size());
  }
  return c;
}

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

constexpr double kNoWay = 1e-6;  // mm: nearer nodes are merged

Result<Track> directed(Track t, Direction direction, const Start& start) {
  const bool against = (direction == Direction::ccw && t.orientation() < 0) ||
                       (direction == Direction::cw && t.orientation() > 0);
  return started(against ? reversed(std::move(t)) : std::move(t), start);
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
  std::vector<CutPoint> before =
      first_stretch(reversed(t), sector.back_up < kNoWay ? 0.0 : sector.back_up);
  for (auto p = before.begin() + 1; p != before.end(); ++p) {
    p->phi -= kTwoPi * whole.turns;
    cut.points.insert(cut.points.begin(), *p);
  }
  cut.closed = false;
  cut.turns = 0;
  return cut;
}

}  // namespace tubecut::motion
