#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "core/bevel/beam/beam_surface.hpp"

/// The cells of the finished surface, and the search for the cell where a beam removes or leaves
/// most.
namespace tubecut::bevel::beam {

inline constexpr double kMargin =
    4.0;  // factor on the slope at corners, because a ridge may lie between them

/// The distance by which the nearest axis is nearer to the surface than half a kerf (`sign` -1) or
/// farther (1).
struct Figure {
  const Surface& surface;
  double half, sign;
  std::vector<double>* by_row = nullptr;  // maximum for each row on whose path the axis is

  /// Computes it for up to kLanes points near one another.
  void operator()(std::span<const SurfacePoint> at, std::span<double> out) const;
  void of(std::span<const SurfacePoint> at, std::span<const Line> lines,
          std::span<double> out) const;

 private:
  void note(const Surface::Seen& seen, double value) const;
};

/// A point and its figure.
struct Found {
  double value = -std::numeric_limits<double>::infinity();
  SurfacePoint at;
};

/// A cell of the surface between four points; the corners: at `from`, at v1, at u1, at both.
struct Cell {
  SurfacePoint from;
  double u1, v1;
  std::array<double, 4> value;
  double along, across;                          // mm
  double steep_along = 0.0, steep_across = 0.0;  // bound of a figure's change, in mm per mm
  double most = 0.0;                             // bound of its value

  [[nodiscard]] double grows_along() const { return steep_along * along; }
  [[nodiscard]] double grows_across() const { return steep_across * across; }
  [[nodiscard]] double highest() const {
    return std::max(std::max(value[0], value[1]), std::max(value[2], value[3]));
  }
};

/// Return the change of a figure along the cell and across it, from corner to corner, mm per mm.
[[nodiscard]] double slope_along(const Cell& c);
[[nodiscard]] double slope_across(const Cell& c);
/// Sets the slope bounds of the cell from those. A ridge may lie between its corners, so each is at
/// least a fraction of the earlier bound: of the cell before, or of the one that contained it. A
/// distance grows no faster than its point moves.
void set_slopes(Cell& c, double share, double along, double across);

/// Finds the largest figure: climbs from the best points, then halves the most promising cell until
/// no cell promises more than the best, or until the halvings are used up.
class Largest {
 public:
  explicit Largest(const Figure& figure) : figure_(figure) {}
  /// Adds a cell with its slopes; figures are those of its corners, times `sign`.
  void see(const Cell& cell, double sign);
  [[nodiscard]] Found worst(int halvings);

 private:
  [[nodiscard]] bool promises(double most) const;
  [[nodiscard]] bool is_near_best(double value) const;
  void keep(const Cell& cell);
  void keep(const Found& found) {
    if (found.value > best_.value) best_ = found;
  }
  [[nodiscard]] std::vector<const Cell*> best_cells() const;
  void climb(const Cell& cell);
  [[nodiscard]] std::array<Cell, 4> quartered(const Cell& cell) const;

  const Figure& figure_;
  std::deque<Cell> cells_;  // because a vector of hundreds of thousands would move at once
  Found best_;
};

}  // namespace tubecut::bevel::beam
