#pragma once

// An oracle of cut walls: the depth of a finished wall in its partners, between the rows of an
// answer and at them. Its inputs are a request and an answer, and it includes core only for those
// two types: its solids are independent, each in a frame made by turning and shifting, and it
// samples the wall point by point.
//
// To verify another wall (a torch line, a kerf's face, a mill's flank), state its edges as a `Wall`
// and the bodies to avoid as `Solid`s; any function of a point will do.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/bevel/table/table.hpp"

namespace tubecut::oracle {

using Point = std::array<double, 3>;

/// How far outside a point lies, mm: negative inside. In the target's frame.
using Solid = std::function<double(const Point&)>;

/// Returns a requested partner; everything nearer to its surface than `grown` (coating and root
/// gap) counts as inside.
[[nodiscard]] Solid solid_of(const joint::Partner& partner, double grown = 0.0);
/// Returns the partners of a table, grown as it requires.
[[nodiscard]] std::vector<Solid> solids_of(const bevel::TableSpec& spec);

/// One edge of a wall: at `radius` about the target's axis, phi (rad) and z (mm) of each row.
struct Edge {
  double radius = 0.0;
  std::vector<double> phi, z;
};

/// A wall by its edges, innermost first. Between two rows every edge runs straight in (phi, z); at
/// every place along the rows the wall is straight in space from one edge to the next. The last
/// row is followed by the first, a turn (`turn`, rad) further on.
struct Wall {
  std::vector<Edge> edges;
  double turn = 0.0;

  [[nodiscard]] std::size_t gaps() const { return edges.front().phi.size(); }
  /// `along` 0..1 from row `gap` to the next, `across` 0..(edges - 1).
  [[nodiscard]] Point at(std::size_t gap, double along, double across) const;
  /// Longest way of an edge from row `gap` to the next, mm.
  [[nodiscard]] double way(std::size_t gap) const;
};

/// The finished surface of a table: inner edge, edge of the land if there is one, outer edge.
[[nodiscard]] Wall finished(const bevel::TableSpec& spec, const bevel::Table& table);

/// The deepest place found. `phi` in rad, not wrapped.
struct Found {
  double depth = 0.0;  // mm; negative: nearest place, that far outside
  std::size_t gap = 0, solid = 0;
  double phi = 0.0, radius = 0.0, z = 0.0;
};

/// How densely a wall is looked at before the best places are refined.
struct Search {
  double step = 0.5;              // mm along the edges, at least 3 and at most 24 a gap
  std::size_t across = 9;         // places between two edges
  std::size_t refined = 40;       // of the best (gap, solid)
  std::uint64_t seed = 20261122;  // of the jitter
  bool rows_only = false;         // nothing between rows
};

/// Every solid against jittered places between rows and on them, across the whole wall and round
/// the seam; the best are refined by a compass search to 1e-6 mm.
[[nodiscard]] Found deepest(const Wall& wall, std::span<const Solid> solids,
                            const Search& search = {});

}  // namespace tubecut::oracle
