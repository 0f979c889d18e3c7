#include "core/bevel/penetration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/joint/solid_arrays.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;
using joint::Places;
using joint::Solid;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An edge of one piece of the wall on its way from one row to the next.
struct Run {
  double radius, phi, z, turn, rise;

  [[nodiscard]] double phi_at(double u) const { return phi + u * turn; }
  /// The place at u, whose phase has this sine and cosine.
  [[nodiscard]] Vector3d place(const elementary::SinCos& to, double u) const {
    return {radius * to.cos, radius * to.sin, z + u * rise};
  }
  [[nodiscard]] Vector3d at(double u) const { return place(elementary::sincos(phi_at(u)), u); }
};

/// The wall between two neighbouring edges, from one row to the next.
struct Piece {
  std::array<Run, 2> runs;
  double steepest = 0.0, most_bent = 0.0;  // of both edges, over the whole way

  [[nodiscard]] Vector3d at(double u, double v) const {
    const Vector3d low = runs[0].at(u);
    return low + v * (runs[1].at(u) - low);
  }
  /// Greatest way of a point whose u grows by `width`, and greatest second derivative over it, mm.
  [[nodiscard]] double way(double width) const { return width * steepest; }
  [[nodiscard]] double bow(double width) const { return width * width * most_bent; }
};

Piece piece_of(const CutWall& wall, std::size_t edge, std::size_t gap) {
  Piece out;
  double square = 0.0;
  const auto next = (gap + 1) % wall.gaps();
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

/// A place that was looked at.
struct Found {
  double depth = -kInfinity;
  Vector3d at = Vector3d::Zero();
  std::size_t solid = 0;
};

/// Where the search stands: a part of a gap of one piece, for one solid.
struct Part {
  std::size_t gap = 0;
  double from = 0.0, to = 1.0;     // along
  double low = 0.0, high = 1.0;    // across
  double first = 0.0, last = 0.0;  // least distance of its two end lines, of a plain solid

  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

/// The wall between two neighbouring edges, all the way round.
struct Ring {
  std::vector<Piece> pieces;    // of each gap
  std::array<Places, 2> edges;  // both ends of the line across, where each begins
};

/// The places of one edge's rows.
Places rows_of(const WallEdge& edge) {
  const auto n = edge.phi.size();
  Places out(n);
  elementary::sincos(edge.phi, out.y, out.x);
  for (std::size_t i = 0; i < n; ++i)
    out.set(i, {edge.radius * out.x[i], edge.radius * out.y[i], edge.z[i]});
  return out;
}

Ring ring_of(const CutWall& wall, std::size_t edge) {
  Ring out{{}, {rows_of(wall.edges[edge]), rows_of(wall.edges[edge + 1])}};
  out.pieces.reserve(wall.gaps());
  for (std::size_t gap = 0; gap < wall.gaps(); ++gap)
    out.pieces.push_back(piece_of(wall, edge, gap));
  return out;
}

/// Searches one ring for one solid, widest parts first. `Aim` tells what is sought: `see` takes
/// every depth found, `enough` the depth that need not be looked for.
template <class Aim, joint::SolidKind Kind>
class Search {
 public:
  Search(const Ring& ring, const Kind& solid, std::size_t index, Aim& aim)
      : ring_(ring), solid_(solid), index_(index), aim_(aim) {}

  void run(const std::stop_token& stop) {
    if constexpr (joint::PlainSolid<Kind>)
      by_levels(
          strips(), [&](const auto& level, auto& next) { halve(level, next, stop); }, stop);
    else
      by_levels(
          cells(), [&](const auto& level, auto& next) { divide(level, next, stop); }, stop);
  }

 private:
  static void by_levels(std::vector<Part> level, auto&& split, const std::stop_token& stop) {
    std::vector<Part> next;
    while (!level.empty() && !stop.stop_requested()) {
      next.clear();
      split(level, next);
      level.swap(next);
    }
  }

  double see(std::size_t gap, const Vector3d& p) {
    const double distance = solid_.distance(p);
    aim_.see(gap, {-distance, p, index_});
    return distance;
  }

  /// A plain solid is searched by strips, each between two lines across the wall: those that the
  /// lines at their ends do not bound at once.
  std::vector<Part> strips() {
    const auto n = ring_.pieces.size();
    std::vector<double> share(n), distance(n);
    joint::nearest_on_ways(solid_, ring_.edges[0], ring_.edges[1], share, distance);
    for (std::size_t gap = 0; gap < n; ++gap) {
      const Vector3d a = ring_.edges[0].at(gap), b = ring_.edges[1].at(gap);
      aim_.see(gap, {-distance[gap], a + share[gap] * (b - a), index_});
    }
    std::vector<Part> out;
    for (std::size_t gap = 0; gap < n; ++gap) {
      const double next = distance[gap + 1 < n ? gap + 1 : 0];
      const double nearest = std::min(distance[gap], next) - 0.5 * ring_.pieces[gap].way(1.0);
      if (!(-nearest > aim_.enough(gap))) continue;
      out.push_back({.gap = gap, .first = distance[gap], .last = next});
    }
    return out;
  }

  /// Another solid is searched by cells. Edges first: the deepest place lies on one of them more
  /// often than not.
  std::vector<Part> cells() {
    std::vector<Part> out(ring_.pieces.size());
    for (std::size_t gap = 0; gap < out.size(); ++gap) {
      out[gap].gap = gap;
      for (const auto& edge : ring_.edges) see(gap, edge.at(gap));
      for (const auto& run : ring_.pieces[gap].runs) see(gap, run.at(0.5));
    }
    return out;
  }

  /// Greatest depth within a strip.
  [[nodiscard]] double bound(const Part& s) const {
    const auto& piece = ring_.pieces[s.gap];
    const double low = std::min(s.first, s.last);
    const double way = piece.way(s.to - s.from);
    const double nearest = low - 0.5 * way;  // no point is further than that from both end lines
    const double bent = solid_.most_bent(nearest);
    const double drop = (bent * way * way + piece.bow(s.to - s.from)) / 8.0;
    return -std::max(nearest, low - drop);
  }

  [[nodiscard]] bool holds_more(const Part& s) const { return bound(s) > aim_.enough(s.gap); }

  /// The lines in the middle of those strips of a level that may hold more than was seen before the
  /// level, side by side; then one strip after the other, since a line that was seen may be enough
  /// for the strips after it.
  void halve(const std::vector<Part>& level, std::vector<Part>& out, const std::stop_token& stop) {
    std::vector<Part> open;
    std::ranges::copy_if(level, std::back_inserter(open),
                         [&](const Part& s) { return holds_more(s); });
    const auto a = middles(open, 0), b = middles(open, 1);
    std::vector<double> share(open.size()), distance(open.size());
    joint::nearest_on_ways(solid_, a, b, share, distance);
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (i % 1024 == 0 && stop.stop_requested()) return;
      const auto& s = open[i];
      if (!holds_more(s)) continue;
      const Vector3d from = a.at(i);
      aim_.see(s.gap, {-distance[i], from + share[i] * (b.at(i) - from), index_});
      Part left = s, right = s;
      left.to = right.from = s.middle();
      left.last = right.first = distance[i];
      out.push_back(left);
      out.push_back(right);
    }
  }

  /// Places of one edge in the middle of each strip.
  [[nodiscard]] Places middles(const std::vector<Part>& strips, std::size_t edge) const {
    std::vector<double> phi(strips.size());
    Places out(strips.size());
    const auto run_of = [&](const Part& s) -> const Run& { return ring_.pieces[s.gap].runs[edge]; };
    for (std::size_t i = 0; i < strips.size(); ++i)
      phi[i] = run_of(strips[i]).phi_at(strips[i].middle());
    elementary::sincos(phi, out.y, out.x);
    for (std::size_t i = 0; i < strips.size(); ++i) {
      const auto& r = run_of(strips[i]);
      out.set(i, r.place({.sin = out.y[i], .cos = out.x[i]}, strips[i].middle()));
    }
    return out;
  }

  void divide(const std::vector<Part>& level, std::vector<Part>& out, const std::stop_token& stop) {
    for (const auto& part : level) {
      if (stop.stop_requested()) return;
      divide(part, out);
    }
  }

  /// Looks at a cell's middle and halves it unless its tangent plane bounds it: along where only
  /// the edges' bow keeps it from that, else the longer way.
  void divide(const Part& c, std::vector<Part>& out) {
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
    Part left = c, right = c;
    const double across = (piece.at(u, c.high) - piece.at(u, c.low)).norm();
    if (plane - distance <= enough || piece.way(c.to - c.from) > across)
      left.to = right.from = u;
    else
      left.high = right.low = v;
    out.push_back(left);
    out.push_back(right);
  }

  const Ring& ring_;
  const Kind& solid_;
  std::size_t index_;
  Aim& aim_;
};

template <class Aim>
void search(const CutWall& wall, std::span<const Solid> solids, Aim& aim,
            const std::stop_token& stop) {
  for (std::size_t edge = 0; edge + 1 < wall.edges.size(); ++edge) {
    const auto ring = ring_of(wall, edge);
    for (std::size_t solid = 0; solid < solids.size() && !stop.stop_requested(); ++solid)
      joint::by_kind(solids[solid].kind(),
                     [&](const auto& kind) { Search(ring, kind, solid, aim).run(stop); });
  }
}

struct Deepest {
  double slack;
  Found best;

  // A number that is no number stays, and fails whatever is proved with it.
  void see(std::size_t /*gap*/, const Found& found) {
    if (found.depth > best.depth || found.depth != found.depth) best = found;
  }
  [[nodiscard]] double enough(std::size_t /*gap*/) const {
    return std::max(best.depth, 0.0) + slack;
  }
};

struct Entering {
  static constexpr double kShare = 0.98;  // so that a depth at the limit itself ends the search
  double limit;
  std::vector<bool> gaps;

  void see(std::size_t gap, const Found& found) {
    if (found.depth > kShare * limit) gaps[gap] = true;
  }
  [[nodiscard]] double enough(std::size_t gap) const { return gaps[gap] ? kInfinity : limit; }
};

}  // namespace

Penetration deepest(const CutWall& wall, std::span<const Solid> solids, double slack,
                    const std::stop_token& stop) {
  Deepest aim{.slack = slack};
  search(wall, solids, aim, stop);
  const auto& [depth, at, solid] = aim.best;
  const double phi = elementary::atan2(at.y(), at.x());
  return {.depth = depth,
          .phi = phi < 0.0 ? phi + kTwoPi : phi,
          .radius = elementary::hypot(at.x(), at.y()),
          .z = at.z(),
          .solid = solid};
}

std::vector<bool> entering(const CutWall& wall, std::span<const Solid> solids, double limit,
                           const std::stop_token& stop) {
  Entering aim{.limit = limit, .gaps = std::vector<bool>(wall.gaps(), false)};
  search(wall, solids, aim, stop);
  return aim.gaps;
}

}  // namespace tubecut::bevel
