#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <span>
#include <stop_token>
#include <vector>

#include "core/bevel/beam/beam_surface.hpp"

/// Where a beam takes or leaves most: pieces of the finished surface, and the search among them.
namespace tubecut::bevel::beam {

inline constexpr double kMargin = 4.0;  // times a slope that corners show: a ridge between them

/// How far the surface is short of half a kerf from the nearest axis (`sign` -1) or beyond it (1).
struct Figure {
  const Surface& surface;
  double half, sign;
  std::vector<double>* by_row = nullptr;  // the most of it, by the rows on whose way the axis is

  /// Of up to kLanes places near one another.
  void operator()(std::span<const Place> at, std::span<double> out) const;
  void of(std::span<const Place> at, std::span<const Line> lines, std::span<double> out) const;

 private:
  void note(const Surface::Seen& seen, double value) const;
};

/// A place and its figure there.
struct Found {
  double value = -std::numeric_limits<double>::infinity();
  Place at;
};

/// A piece of the surface between four places; the corners: at `from`, at v1, at u1, at both.
struct Cell {
  Place from;
  double u1, v1;
  std::array<double, 4> value;
  double along, across;                          // mm
  double steep_along = 0.0, steep_across = 0.0;  // what a figure may change by, in mm a mm
  double most = 0.0;                             // what it may hold

  [[nodiscard]] double grows_along() const { return steep_along * along; }
  [[nodiscard]] double grows_across() const { return steep_across * across; }
  [[nodiscard]] double highest() const {
    return std::max(std::max(value[0], value[1]), std::max(value[2], value[3]));
  }
};

/// By how much a figure changes along the cell, and across it, from corner to corner, mm a mm.
[[nodiscard]] double slope_along(const Cell& c);
[[nodiscard]] double slope_across(const Cell& c);
/// Sets how steep the cell may be from those; a ridge may stand between its corners, so it is no
/// less than a share of what it was: of the cell before, or of the one it is a part of. A distance
/// grows no faster than its point moves.
void set_slopes(Cell& c, double share, double along, double across);

/// The largest figure: from the best places uphill, then the cell that promises most is halved
/// until none promises more than is known, or for as long as is granted.
class Largest {
 public:
  explicit Largest(const Figure& figure) : figure_(figure) {}
  /// A cell with its slopes; figures are those of its corners, times `sign`.
  void see(const Cell& cell, double sign);
  [[nodiscard]] Found worst(int halvings, const std::stop_token& stop);

 private:
  [[nodiscard]] bool promises(double most) const;
  [[nodiscard]] bool is_near_best(double value) const;
  void keep(const Cell& cell);
  void keep(const Found& found) {
    if (found.value > best_.value) best_ = found;
  }
  [[nodiscard]] std::vector<const Cell*> best_cells(const std::stop_token& stop) const;
  void climb(const Cell& cell, const std::stop_token& stop);
  [[nodiscard]] std::array<Cell, 4> quartered(const Cell& cell) const;

  const Figure& figure_;
  std::deque<Cell> cells_;  // a vector of hundred thousands would move in one piece
  Found best_;
};

}  // namespace tubecut::bevel::beam
