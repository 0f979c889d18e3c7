#include "core/bevel/beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <tuple>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/beam_surface.hpp"
#include "core/bevel/beam_swings.hpp"

namespace tubecut::bevel {
namespace {

using beam::mixed;
using beam::Place;
using beam::Surface;

constexpr double kPlaces = 2000.0;  // along the cut, beside the rows and their middles
constexpr double kFine = 0.25;      // of half a kerf: across the wall, where they are
constexpr double kMostLines = 48;
constexpr int kFewest = 2, kMost = 8;  // stretches across the wall
constexpr int kFiner = 3;              // each way, for cuts that bend
constexpr double kTiny = 1e-300;
constexpr int kHalvings = 250;       // at most, of cells between places; most cuts need some ten
constexpr int kHalvingsOfRows = 40;  // likewise, where no more than what is there is asked for
constexpr double kKept = 0.8;        // of a cell's slope, by its halves
constexpr double kMargin = 4.0;      // times a slope that corners show: a ridge between them
constexpr double kTold = 2e-3;       // mm: a cell that promises no more than this is left alone,
constexpr double kToldShare = 8e-3;  // nor one that promises only so much of what is known

/// How far the surface is short of half a kerf from the nearest axis (`sign` -1) or beyond it (1).
struct Figure {
  const Surface& surface;
  double half, sign;
  std::vector<double>* by_row = nullptr;  // the most of it, by the rows on whose way the axis is

  [[nodiscard]] double operator()(const Place& at) const { return of(surface.seen(at)); }
  [[nodiscard]] double of(const Surface::Seen& seen) const {
    const double value = sign * (seen.distance - half);
    if (by_row != nullptr && value > 0.0) note(seen, value);
    return value;
  }

 private:
  void note(const Surface::Seen& seen, double value) const {
    constexpr double kAtRow = 1e-6;  // of the way to the next
    const auto see = [&](std::size_t row) { (*by_row)[row] = std::max((*by_row)[row], value); };
    if (seen.u < 1.0 - kAtRow) see(seen.row);
    if (seen.u > kAtRow) see((seen.row + 1) % by_row->size());
  }
};

/// A place and its figure there.
struct Seen {
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

  [[nodiscard]] double grows_along() const { return steep_along * along; }
  [[nodiscard]] double grows_across() const { return steep_across * across; }
  [[nodiscard]] double highest() const { return *std::ranges::max_element(value); }
  [[nodiscard]] double most() const { return highest() + 0.5 * (grows_along() + grows_across()); }
};

/// By how much a figure changes along the cell, and across it, from corner to corner, mm a mm.
double slope_along(const Cell& c) {
  const auto& [a, b, d, e] = c.value;
  return std::max(std::abs(d - a), std::abs(e - b)) / (c.along + kTiny);
}
double slope_across(const Cell& c) {
  const auto& [a, b, d, e] = c.value;
  return std::max(std::abs(b - a), std::abs(e - d)) / (c.across + kTiny);
}

/// Sets how steep the cell may be from its corners; a ridge may stand between them, so it is no
/// less than a share of what it was: of the cell before, or of the one it is a half of. A distance
/// grows no faster than its point moves.
Cell with_slopes(Cell c, double share) {
  c.steep_along = std::min(1.0, std::max(share * c.steep_along, kMargin * slope_along(c)));
  c.steep_across = std::min(1.0, std::max(share * c.steep_across, kMargin * slope_across(c)));
  return c;
}

/// The largest figure: from the best places uphill, then the cell that promises most is halved
/// until none promises more than is known, or for as long as is granted.
class Largest {
 public:
  explicit Largest(const Figure& figure) : figure_(figure) {}
  void see(const Cell& seen) {
    keep(seen);
    // What is known only grows: a cell that is of no use now is of none at the end.
    const Cell cell = with_slopes(seen, kMargin);
    if (promises(cell) || is_near_best(cell)) cells_.push_back(cell);
  }

  [[nodiscard]] Seen worst(int halvings, const std::stop_token& stop) {
    for (const Cell* start : best_cells(stop)) climb(*start, stop);
    if (stop.stop_requested()) return best_;
    std::ranges::make_heap(cells_, {}, &Cell::most);
    while (halvings-- > 0 && !cells_.empty() && !stop.stop_requested()) {
      std::ranges::pop_heap(cells_, {}, &Cell::most);
      const Cell cell = cells_.back();
      cells_.pop_back();
      if (!promises(cell)) break;
      for (const auto& half : halved(cell, cell.grows_along() > cell.grows_across())) {
        keep(half);
        cells_.push_back(with_slopes(half, kKept));
        std::ranges::push_heap(cells_, {}, &Cell::most);
      }
    }
    return best_;
  }

 private:
  /// More than is known, by as much as is told.
  [[nodiscard]] bool promises(const Cell& cell) const {
    const double known = std::max(0.0, best_.value);
    return cell.most() > known + std::max(kTold, kToldShare * known);
  }
  [[nodiscard]] bool is_near_best(const Cell& cell) const {
    constexpr double kNearly = 0.85;
    return cell.highest() > std::max(kTold, kNearly * best_.value);
  }

  void keep(const Cell& cell) { keep(highest(cell)); }
  void keep(const Seen& seen) {
    if (seen.value > best_.value) best_ = seen;
  }
  static Seen highest(const Cell& cell) {
    const auto k =
        static_cast<std::size_t>(std::ranges::max_element(cell.value) - cell.value.begin());
    Seen out{cell.value[k], cell.from};
    if (k & 1U) out.at.v = cell.v1;
    if (k & 2U) out.at.u = cell.u1;
    return out;
  }

  /// Few cells that are not neighbours and show nearly as much as any.
  [[nodiscard]] std::vector<const Cell*> best_cells(const std::stop_token& stop) const {
    constexpr std::size_t kPool = 64, kClimbs = 6;
    std::vector<const Cell*> pool;
    std::size_t seen = 0;
    for (const Cell& cell : cells_) {
      if (stops(stop, seen++)) return {};
      if (is_near_best(cell)) pool.push_back(&cell);
    }
    const auto top = pool.begin() + static_cast<std::ptrdiff_t>(std::min(kPool, pool.size()));
    std::ranges::partial_sort(pool, top, std::ranges::greater{}, &Cell::highest);
    std::vector<const Cell*> out;
    for (auto cell = pool.begin(); cell != top && out.size() < kClimbs; ++cell)
      if (std::ranges::none_of(out, [&](const Cell* other) { return neighbours(*other, **cell); }))
        out.push_back(*cell);
    return out;
  }
  static bool neighbours(const Cell& a, const Cell& b) {
    const auto [low, high] = std::minmax(a.from.row, b.from.row);
    return high - low <= 1;
  }

  /// From a cell's best corner to a place from which no step of a hundredth of the cell leads up.
  void climb(const Cell& cell, const std::stop_token& stop) {
    constexpr int kSteps = 100;
    Seen here = highest(cell);
    double along = 0.5 * cell.along, across = 0.5 * cell.across;
    for (int step = 0; step < kSteps && along > 0.01 * cell.along; ++step) {
      if (stop.stop_requested()) return;
      const std::array<Place, 4> beside{figure_.surface.moved(here.at, along, 0.0),
                                        figure_.surface.moved(here.at, -along, 0.0),
                                        figure_.surface.moved(here.at, 0.0, across),
                                        figure_.surface.moved(here.at, 0.0, -across)};
      const Seen before = here;
      for (const Place& at : beside)
        if (const double value = figure_(at); value > here.value) here = {value, at};
      if (here.value > before.value) continue;
      along *= 0.5;
      across *= 0.5;
    }
    keep(here);
  }

  /// Both halves, of its length along the cut or across the wall.
  [[nodiscard]] std::array<Cell, 2> halved(Cell low, bool along) const {
    const std::size_t next = along ? 2 : 1, beside = along ? 1 : 2;  // corners, from the first one
    Place at = low.from;
    double& middle = along ? at.u : at.v;
    double& end = along ? low.u1 : low.v1;
    middle = mixed(middle, end, 0.5);
    const double near = figure_(at);
    Place over = at;
    (along ? over.v : over.u) = along ? low.v1 : low.u1;
    const double far = figure_(over);
    (along ? low.along : low.across) *= 0.5;
    Cell high = low;
    high.from = at;
    end = middle;
    high.value[0] = low.value[next] = near;
    high.value[beside] = low.value[3] = far;
    return {low, high};
  }

  const Figure& figure_;
  std::deque<Cell> cells_;  // a vector of hundred thousands would move in one piece
  Seen best_;
};

struct Grid {
  double apart;            // mm, along the cut
  int lines;               // stretches across the wall
  std::size_t first, end;  // rows
  bool land = false;
};

/// All cells of the grid, with their figures.
template <class See>
void see_cells(const Figure& figure, const Grid& grid, const std::stop_token& stop,
               const See& see) {
  const auto& surface = figure.surface;
  std::vector<double> before, here;
  std::vector<Cell> last(static_cast<std::size_t>(grid.lines));
  const auto share = [&](int m) { return static_cast<double>(m) / grid.lines; };
  const auto line_up = [&](std::size_t row, double u) {
    before.swap(here);
    here.clear();
    const auto line = surface.across_wall(row, u, grid.land);
    for (int m = 0; m <= grid.lines; ++m)
      here.push_back(stop.stop_requested()
                         ? 0.0  // a place may take long: a wide kerf has many lines near it
                         : figure.of(surface.seen({row, u, share(m), grid.land}, line)));
  };
  line_up(grid.first, 0.0);
  for (std::size_t i = grid.first; i < grid.end && !stop.stop_requested(); ++i) {
    const double step = surface.step(i), wide = surface.across(i, grid.land) / grid.lines;
    const int parts = std::max(1, static_cast<int>(std::ceil(step / grid.apart)));
    for (int k = 0; k < parts && !stop.stop_requested(); ++k) {
      const double u = static_cast<double>(k) / parts, u1 = static_cast<double>(k + 1) / parts;
      line_up(i, u1);
      for (int m = 0; m < grid.lines; ++m) {
        const auto a = static_cast<std::size_t>(m), b = a + 1;
        const Cell cell{.from = {i, u, share(m), grid.land},
                        .u1 = u1,
                        .v1 = share(m + 1),
                        .value = {before[a], before[b], here[a], here[b]},
                        .along = step / parts,
                        .across = wide,
                        .steep_along = slope_along(last[a]),
                        .steep_across = slope_across(last[a])};
        last[a] = cell;
        see(cell);
      }
    }
  }
}

/// Stretches across the wall: more in walls thick beside the kerf.
int lines(const BeamCut& cut) {
  constexpr double kKerfs = 4.0;
  if (cut.kerf == 0.0) return kFewest;
  const double parts = std::ceil((cut.outer - cut.inner) / (kKerfs * cut.kerf + kTiny));
  return static_cast<int>(std::clamp(parts, 1.0 * kFewest, 1.0 * kMost));
}

/// What is found everywhere is no less than what rows alone show.
void no_less_than(const BeamFound& rows, BeamFound& all) {
  auto& [proof, gouged_from] = all;
  if (rows.proof.gouge > proof.gouge)
    std::tie(proof.gouge, proof.gouge_phi) = std::tie(rows.proof.gouge, rows.proof.gouge_phi);
  if (rows.proof.left > proof.left)
    std::tie(proof.left, proof.left_phi) = std::tie(rows.proof.left, rows.proof.left_phi);
  std::ranges::transform(gouged_from, rows.gouged_from, gouged_from.begin(),
                         [](double a, double b) { return std::max(a, b); });
}

BeamFound found_at(const BeamCut& cut, const Surface& surface, Places places,
                   const std::stop_token& stop) {
  BeamFound out{.gouged_from = std::vector<double>(cut.torch.size(), 0.0)};
  if (stop.stop_requested()) return out;
  const double half = 0.5 * cut.kerf;
  const bool rows_only = places == Places::rows;
  double length = 0.0;
  for (std::size_t i = 0; i < surface.rows(); ++i) length += surface.step(i);
  const Figure short_of{surface, half, -1.0, &out.gouged_from}, beyond{surface, half, 1.0};
  Largest gouges(short_of), lefts(beyond);
  const auto see = [&](Cell cell) {
    gouges.see(cell);
    if (cell.from.land) return;
    for (double& value : cell.value) value = -value;
    lefts.see(cell);
  };
  const int finer = places == Places::finely ? kFiner : 1;
  Grid grid{
      .apart = rows_only || half == 0.0 ? length : std::max(0.5 * half, length / kPlaces) / finer,
      .lines = rows_only ? 1 : finer * lines(cut),
      .first = 0,
      .end = surface.rows()};
  see_cells(short_of, grid, stop, see);
  grid.land = true;
  if (!cut.land.empty()) see_cells(short_of, grid, stop, see);
  grid.land = false;
  grid.lines = static_cast<int>(
      std::clamp((cut.outer - cut.inner) / (kFine * half + kTiny), 1.0 * lines(cut), kMostLines));
  if (!rows_only && half > 0.0)
    for (const auto& [first, end] : beam::swings(cut, stop)) {
      grid.first = first;
      grid.end = end;
      see_cells(short_of, grid, stop, see);
    }
  if (stop.stop_requested()) return out;
  const int halvings = rows_only ? kHalvingsOfRows : kHalvings;
  const auto gouge = gouges.worst(halvings, stop), left = lefts.worst(halvings, stop);
  out.proof = {.gouge = std::max(0.0, gouge.value),
               .gouge_phi = surface.phase(gouge.at),
               .left = std::max(0.0, left.value),
               .left_phi = surface.phase(left.at)};
  return out;
}

}  // namespace

BeamFound beam_found(const BeamCut& cut, Places places, const std::stop_token& stop) {
  if (cut.kerf == 0.0 && cut.land.empty() && cut.torch == cut.finished)
    return {.gouged_from = std::vector<double>(cut.torch.size(), 0.0)};
  const Surface surface(cut, stop);
  auto out = found_at(cut, surface, places, stop);
  if (places != Places::rows) no_less_than(found_at(cut, surface, Places::rows, stop), out);
  return out;
}

BeamProof clear_torch(std::size_t rows, const std::function<BeamCut(const Further&)>& cut,
                      const std::stop_token& stop) {
  constexpr double kAimed = 0.7 * kGougeLimit;  // a little more may be taken than is found
  constexpr double kMore = 1.25;  // moved off the line's own surface, that next to it gains less
  constexpr int kRounds = 8;
  Further further(rows, 0.0);
  for (int round = 0;; ++round) {
    const auto moved = cut(further);
    const bool bends = round > 0 && moved.turn == 0.0;  // an end's drop is the least already
    const auto found = beam_found(moved, bends ? Places::finely : Places::everywhere, stop);
    if (!(found.proof.gouge > kAimed) || round == kRounds || stop.stop_requested())
      return found.proof;
    for (std::size_t i = 0; i < rows; ++i) further[i] += kMore * found.gouged_from[i];
    if (std::ranges::max(further) > moved.kerf) return found.proof;
  }
}

}  // namespace tubecut::bevel
