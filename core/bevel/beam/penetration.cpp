#include "core/bevel/beam/penetration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/joint/solid_arrays.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;
using joint::PointArrays;
using joint::Solid;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An edge of one part of the wall from one row to the next.
struct Run {
  double radius, phi, z, turn, rise;

  [[nodiscard]] double phi_at(double u) const { return phi + u * turn; }
  /// Returns the point at u, whose phase has this sine and cosine.
  [[nodiscard]] Vector3d place(const elementary::SinCos& to, double u) const {
    return {radius * to.cos, radius * to.sin, z + u * rise};
  }
  [[nodiscard]] Vector3d at(double u) const { return place(elementary::sincos(phi_at(u)), u); }
};

/// The wall between two neighbouring edges, from one row to the next.
struct WallStrip {
  std::array<Run, 2> runs;
  double steepest = 0.0, most_bent = 0.0;  // of both edges, over the whole interval

  [[nodiscard]] Vector3d at(double u, double v) const {
    const Vector3d low = runs[0].at(u);
    return low + v * (runs[1].at(u) - low);
  }
  /// Return the maximum path of a point whose u grows by `width`, and its maximum second derivative
  /// over it, mm.
  [[nodiscard]] double way(double width) const { return width * steepest; }
  [[nodiscard]] double bow(double width) const { return width * width * most_bent; }
};

WallStrip piece_of(const CutWall& wall, std::size_t edge, std::size_t gap) {
  WallStrip out;
  double square = 0.0;
  const auto next = gap + 1 < wall.gaps() ? gap + 1 : 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& e = wall.edges[edge + k];
    out.runs[k] = {e.radius, e.phi[gap], e.z[gap],
                   e.phi[next] - e.phi[gap] + (next == 0 ? wall.turn : 0.0), e.z[next] - e.z[gap]};
    const auto& r = out.runs[k];
    const double round = r.radius * r.turn;
    square = std::max(square, round * round + r.rise * r.rise);
    out.most_bent = std::max(out.most_bent, std::abs(round * r.turn));
  }
  out.steepest = std::sqrt(square);
  return out;
}

/// A point that was checked.
struct Found {
  double depth = -kInfinity;
  Vector3d at = Vector3d::Zero();
  std::size_t solid = 0;
};

/// A part of a gap, across the whole wall, in the search of a plain solid.
struct Strip {
  std::size_t gap = 0;
  double from = 0.0, to = 1.0;     // along
  double first = 0.0, last = 0.0;  // smallest distance of its two end lines
  double most = 0.0;               // bound of the depth within

  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

/// A part of a gap, along and across, in the search of any other solid.
struct WallCell {
  std::size_t gap = 0;
  double from = 0.0, to = 1.0;   // along
  double low = 0.0, high = 1.0;  // across

  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

/// The wall between two neighbouring edges, all the way around.
struct RowRing {
  std::vector<WallStrip> pieces;  // of each gap
  std::vector<double>
      ways;  // `way(1)` of each piece, stored separately because most pieces need nothing else
  std::array<PointArrays, 2> edges;  // both ends of the line across at the start of each piece
  bool axial = false;                // both edges run through the same phases
};

/// Returns points with the cosines and sines of both edges' phases for x and y. If `axial`, as for
/// an end, both edges have equal phases.
std::array<PointArrays, 2> turned(std::span<const double> low, std::span<const double> high,
                                  bool axial) {
  std::array<PointArrays, 2> out{PointArrays(low.size()), PointArrays(low.size())};
  elementary::sincos(low, out[0].y, out[0].x);
  if (axial)
    out[1] = out[0];
  else
    elementary::sincos(high, out[1].y, out[1].x);
  return out;
}

/// Returns the points of both edges' rows.
std::array<PointArrays, 2> rows_of(const WallEdge& low, const WallEdge& high, bool axial) {
  const auto n = low.phi.size();
  auto out = turned(low.phi, high.phi, axial);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& edge = k == 0 ? low : high;
    for (std::size_t i = 0; i < n; ++i) {
      out[k].x[i] *= edge.radius;
      out[k].y[i] *= edge.radius;
    }
    out[k].z.assign(edge.z.begin(), edge.z.end());
  }
  return out;
}

RowRing ring_of(const CutWall& wall, std::size_t edge) {
  const auto &low = wall.edges[edge], &high = wall.edges[edge + 1];
  const bool axial = std::ranges::equal(low.phi, high.phi);
  RowRing out{{}, {}, rows_of(low, high, axial), axial};
  out.pieces.reserve(wall.gaps());
  out.ways.reserve(wall.gaps());
  for (std::size_t gap = 0; gap < wall.gaps(); ++gap) {
    out.pieces.push_back(piece_of(wall, edge, gap));
    out.ways.push_back(out.pieces.back().way(1.0));
  }
  return out;
}

/// Searches one ring for one solid, widest parts first. `Aim` specifies the goal: `see` takes every
/// depth found, `enough` returns the depth below which the search stops.
template <class Aim, joint::SolidKind Kind>
class Search {
 public:
  Search(const RowRing& ring, const Kind& solid, std::size_t index, Aim& aim)
      : ring_(ring), solid_(solid), index_(index), aim_(aim) {}

  void run() {
    if constexpr (joint::PlainSolid<Kind>)
      by_levels(strips(), [&](auto& level, auto& next) { halve(level, next); });
    else
      by_levels(cells(), [&](const auto& level, auto& next) { divide(level, next); });
  }

 private:
  template <class Part>
  static void by_levels(std::vector<Part> level, auto&& split) {
    std::vector<Part> next;
    while (!level.empty() && !stopped()) {
      next.clear();
      split(level, next);
      level.swap(next);
    }
  }

  double see(std::size_t gap, const Vector3d& p) {
    const double distance = solid_.distance(p);
    aim_.see(gap, -distance, [&] { return Found{-distance, p, index_}; });
    return distance;
  }
  /// Passes the nearest point of the line across from `a` to `b` to the aim.
  void see(std::size_t gap, double distance, double share, const PointArrays& a,
           const PointArrays& b, std::size_t i) {
    aim_.see(gap, -distance, [&] {
      return Found{-distance, a.at(i) + share * (b.at(i) - a.at(i)), index_};
    });
  }

  /// Returns the strips of a plain solid, each between two lines across the wall, that the lines at
  /// their ends do not bound at once.
  std::vector<Strip> strips() {
    const auto n = ring_.pieces.size();
    const auto& [a, b] = ring_.edges;
    std::vector<double> share(n), distance(n);
    joint::nearest_on_ways(solid_, a, b, share, distance);
    for (std::size_t gap = 0; gap < n; ++gap) see(gap, distance[gap], share[gap], a, b, gap);
    std::vector<Strip> out;
    for (std::size_t gap = 0; gap < n; ++gap) {
      const double next = distance[gap + 1 < n ? gap + 1 : 0];
      const double nearest = std::min(distance[gap], next) - 0.5 * ring_.ways[gap];
      if (-nearest > aim_.enough(gap)) keep({gap, 0.0, 1.0, distance[gap], next}, out);
    }
    return out;
  }

  /// Returns the cells of any other solid. Edges first, because the deepest point is usually on one
  /// of them.
  std::vector<WallCell> cells() {
    std::vector<WallCell> out(ring_.pieces.size());
    for (std::size_t gap = 0; gap < out.size(); ++gap) {
      out[gap].gap = gap;
      for (const auto& edge : ring_.edges) see(gap, edge.at(gap));
      for (const auto& run : ring_.pieces[gap].runs) see(gap, run.at(0.5));
    }
    return out;
  }

  /// Keeps a strip if its bound of the depth is more than enough.
  void keep(Strip strip, std::vector<Strip>& out) const {
    const auto& piece = ring_.pieces[strip.gap];
    const double low = std::min(strip.first, strip.last), width = strip.to - strip.from;
    const double way = piece.way(width);
    const double nearest =
        low - 0.5 * way;  // because no point is further than that from both end lines
    const double bent = solid_.most_bent(nearest);
    const double drop = (bent * way * way + piece.bow(width)) / 8.0;
    strip.most = -std::max(nearest, low - drop);
    if (holds_more(strip)) out.push_back(strip);
  }
  [[nodiscard]] bool holds_more(const Strip& s) const { return s.most > aim_.enough(s.gap); }

  /// Checks the lines in the middle of those strips of a level that may exceed the depth found so
  /// far, in parallel; then one strip after the other, because a result may be enough for the
  /// strips after it.
  void halve(std::vector<Strip>& open, std::vector<Strip>& out) {
    std::erase_if(open, [&](const Strip& s) { return !holds_more(s); });
    const auto [a, b] = middles(open);
    std::vector<double> share(open.size()), distance(open.size());
    joint::nearest_on_ways(solid_, a, b, share, distance);
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (i % 1024 == 0 && stopped()) return;
      const auto& s = open[i];
      if (!holds_more(s)) continue;
      see(s.gap, distance[i], share[i], a, b, i);
      keep({s.gap, s.from, s.middle(), s.first, distance[i]}, out);
      keep({s.gap, s.middle(), s.to, distance[i], s.last}, out);
    }
  }

  /// Returns both ends of the line across in the middle of each strip.
  [[nodiscard]] std::array<PointArrays, 2> middles(const std::vector<Strip>& strips) const {
    const auto n = strips.size();
    const auto run_of = [&](std::size_t i, std::size_t k) -> const Run& {
      return ring_.pieces[strips[i].gap].runs[k];
    };
    std::array<std::vector<double>, 2> phi{std::vector<double>(n), std::vector<double>(n)};
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < n; ++i) phi[k][i] = run_of(i, k).phi_at(strips[i].middle());
    auto out = turned(phi[0], phi[1], ring_.axial);
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < n; ++i) {
        const elementary::SinCos turn{.sin = out[k].y[i], .cos = out[k].x[i]};
        out[k].set(i, run_of(i, k).place(turn, strips[i].middle()));
      }
    return out;
  }

  void divide(const std::vector<WallCell>& level, std::vector<WallCell>& out) {
    for (const auto& cell : level) {
      if (stopped()) return;
      divide(cell, out);
    }
  }

  /// Checks a cell's middle and halves the cell unless its tangent plane bounds it: along, if only
  /// the edges' bow prevents the bound, else the longer direction.
  void divide(const WallCell& c, std::vector<WallCell>& out) {
    const auto& piece = ring_.pieces[c.gap];
    const double u = c.middle(), v = 0.5 * (c.low + c.high);
    const Vector3d middle = piece.at(u, v);
    const double distance = see(c.gap, middle);
    const Vector3d normal = solid_.normal(middle);
    double fall = 0.0, reach = 0.0;
    Vector3d lowest = middle;
    for (const double along : {c.from, c.to})
      for (const double across : {c.low, c.high}) {
        const Vector3d corner = piece.at(along, across);
        if (const double to = normal.dot(corner - middle); to < fall) {
          fall = to;
          lowest = corner;
        }
        reach = std::max(reach, (corner - middle).norm());
      }
    see(c.gap, lowest);
    const double bow = piece.bow(c.to - c.from) / 8.0;
    reach += bow;
    const double hollow = solid_.most_hollow(distance + reach);
    const double plane = 0.5 * hollow * reach * reach - fall;
    const double enough = aim_.enough(c.gap);
    if (!(std::min(reach, plane + bow) - distance > enough)) return;
    WallCell left = c, right = c;
    const double across = (piece.at(u, c.high) - piece.at(u, c.low)).norm();
    if (plane - distance <= enough || piece.way(c.to - c.from) > across)
      left.to = right.from = u;
    else
      left.high = right.low = v;
    out.push_back(left);
    out.push_back(right);
  }

  const RowRing& ring_;
  const Kind& solid_;
  std::size_t index_;
  Aim& aim_;
};

template <class Aim>
void search(const CutWall& wall, std::span<const Solid> solids, Aim& aim) {
  for (std::size_t edge = 0; edge + 1 < wall.edges.size() && !stopped(); ++edge) {
    const auto ring = ring_of(wall, edge);
    for (std::size_t solid = 0; solid < solids.size() && !stopped(); ++solid)
      joint::by_kind(solids[solid].kind(),
                     [&](const auto& kind) { Search(ring, kind, solid, aim).run(); });
  }
}

struct Deepest {
  double slack;
  Found best;

  // NaN stays, so every check that uses it fails.
  void see(std::size_t /*gap*/, double depth, const auto& found) {
    if (depth > best.depth || depth != depth) best = found();
  }
  [[nodiscard]] double enough(std::size_t /*gap*/) const {
    return std::max(best.depth, 0.0) + slack;
  }
};

struct Entering {
  static constexpr double kShare = 0.98;  // so that a depth at the limit itself ends the search
  double limit;
  std::vector<bool> gaps;

  void see(std::size_t gap, double depth, const auto& /*found*/) {
    if (depth > kShare * limit) gaps[gap] = true;
  }
  [[nodiscard]] double enough(std::size_t gap) const { return gaps[gap] ? kInfinity : limit; }
};

}  // namespace

Penetration deepest(const CutWall& wall, std::span<const Solid> solids, double slack) {
  Deepest aim{.slack = slack};
  search(wall, solids, aim);
  const auto& [depth, at, solid] = aim.best;
  const double phi = elementary::atan2(at.y(), at.x());
  return {.depth = depth,
          .phi = phi < 0.0 ? phi + kTwoPi : phi,
          .radius = elementary::hypot(at.x(), at.y()),
          .z = at.z(),
          .solid = solid};
}

std::vector<bool> entering(const CutWall& wall, std::span<const Solid> solids, double limit) {
  Entering aim{.limit = limit, .gaps = std::vector<bool>(wall.gaps(), false)};
  search(wall, solids, aim);
  return aim.gaps;
}

}  // namespace tubecut::bevel
