#include "core/bevel/beam/beam_cells.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/stop.hpp"

namespace tubecut::bevel::beam {
namespace {

constexpr double kKept = 0.8;  // fraction of a cell's slope that its halves keep
constexpr double kTold =
    2e-3;  // mm: if a cell can exceed the best by no more than this, it is dropped,
constexpr double kToldShare = 8e-3;   // or by no more than this fraction of the best
constexpr double kNoLength = 1e-300;  // mm: cells may have zero length

void set_most(Cell& c) { c.most = c.highest() + 0.5 * (c.grows_along() + c.grows_across()); }

Found highest(const Cell& cell) {
  const auto k =
      static_cast<std::size_t>(std::ranges::max_element(cell.value) - cell.value.begin());
  Found out{cell.value[k], cell.from};
  if (k & 1U) out.at.v = cell.v1;
  if (k & 2U) out.at.u = cell.u1;
  return out;
}

bool neighbours(const Cell& a, const Cell& b) {
  const auto [low, high] = std::minmax(a.from.row, b.from.row);
  return high - low <= 1;
}

}  // namespace

void Figure::operator()(std::span<const SurfacePoint> at, std::span<double> out) const {
  std::array<Line, kLanes> lines;
  surface.across_wall(at, lines);
  of(at, lines, out);
}

void Figure::of(std::span<const SurfacePoint> at, std::span<const Line> lines,
                std::span<double> out) const {
  std::array<Surface::Seen, kLanes> seen;
  surface.seen(at, lines, std::span(seen).first(at.size()));
  for (std::size_t k = 0; k < at.size(); ++k) {
    out[k] = sign * (seen[k].distance - half);
    if (by_row != nullptr && out[k] > 0.0) note(seen[k], out[k]);
  }
}

void Figure::note(const Surface::Seen& seen, double value) const {
  constexpr double kAtRow = 1e-6;  // of the path to the next
  const auto see = [&](std::size_t row) { (*by_row)[row] = std::max((*by_row)[row], value); };
  if (seen.u < 1.0 - kAtRow) see(seen.row);
  if (seen.u > kAtRow) see((seen.row + 1) % by_row->size());
}

double slope_along(const Cell& c) {
  const auto& [a, b, d, e] = c.value;
  return std::max(std::abs(d - a), std::abs(e - b)) / (c.along + kNoLength);
}
double slope_across(const Cell& c) {
  const auto& [a, b, d, e] = c.value;
  return std::max(std::abs(b - a), std::abs(e - d)) / (c.across + kNoLength);
}

void set_slopes(Cell& c, double share, double along, double across) {
  c.steep_along = std::min(1.0, std::max(share * c.steep_along, kMargin * along));
  c.steep_across = std::min(1.0, std::max(share * c.steep_across, kMargin * across));
}

void Largest::see(const Cell& cell, double sign) {
  double highest = sign * cell.value[0];
  for (const double value : cell.value) highest = std::max(highest, sign * value);
  const double most = highest + 0.5 * (cell.grows_along() + cell.grows_across());
  // The best only grows, so a cell that is useless now stays useless.
  if (!(highest > best_.value || promises(most) || is_near_best(highest))) return;
  Cell own = cell;
  for (double& value : own.value) value *= sign;
  own.most = most;
  keep(own);
  if (promises(most) || is_near_best(highest)) cells_.push_back(own);
}

Found Largest::worst(int halvings) {
  for (const Cell* start : best_cells()) climb(*start);
  if (stopped()) return best_;
  std::vector<Cell> left;  // few of hundreds of thousands of cells can still exceed the best
  std::size_t seen = 0;
  for (const Cell& cell : cells_) {
    if (stops(seen++)) return best_;
    if (promises(cell.most)) left.push_back(cell);
  }
  std::ranges::make_heap(left, {}, &Cell::most);
  while (halvings-- > 0 && !left.empty() && !stopped()) {
    std::ranges::pop_heap(left, {}, &Cell::most);
    const Cell cell = left.back();
    left.pop_back();
    if (!promises(cell.most)) break;
    for (const auto& part : quartered(cell)) {
      keep(part);
      if (!promises(part.most)) continue;
      left.push_back(part);
      std::ranges::push_heap(left, {}, &Cell::most);
    }
    halvings -= 2;
  }
  return best_;
}

/// Returns true if `most` exceeds the best by a relevant amount.
bool Largest::promises(double most) const {
  const double known = std::max(0.0, best_.value);
  return most > known + std::max(kTold, kToldShare * known);
}

bool Largest::is_near_best(double value) const {
  constexpr double kNearly = 0.85;
  return value > std::max(kTold, kNearly * best_.value);
}

void Largest::keep(const Cell& cell) {
  if (cell.highest() > best_.value) best_ = highest(cell);
}

/// Returns a few cells that are not neighbours and have nearly the best value.
std::vector<const Cell*> Largest::best_cells() const {
  constexpr std::size_t kPool = 64, kClimbs = 6;
  std::vector<const Cell*> pool;
  std::size_t seen = 0;
  for (const Cell& cell : cells_) {
    if (stops(seen++)) return {};
    if (is_near_best(cell.highest())) pool.push_back(&cell);
  }
  const auto top = pool.begin() + static_cast<std::ptrdiff_t>(std::min(kPool, pool.size()));
  std::ranges::partial_sort(pool, top, std::ranges::greater{}, &Cell::highest);
  std::vector<const Cell*> out;
  for (auto cell = pool.begin(); cell != top && out.size() < kClimbs; ++cell)
    if (std::ranges::none_of(out, [&](const Cell* other) { return neighbours(*other, **cell); }))
      out.push_back(*cell);
  return out;
}
/// Climbs from a cell's best corner to a point from which no step of a hundredth of the cell leads
/// up.
void Largest::climb(const Cell& cell) {
  constexpr int kSteps = 100;
  Found here = highest(cell);
  double along = 0.5 * cell.along, across = 0.5 * cell.across;
  for (int step = 0; step < kSteps && along > 0.01 * cell.along; ++step) {
    if (stopped()) return;
    const std::array<SurfacePoint, 4> beside{
        figure_.surface.moved(here.at, along, 0.0), figure_.surface.moved(here.at, -along, 0.0),
        figure_.surface.moved(here.at, 0.0, across), figure_.surface.moved(here.at, 0.0, -across)};
    std::array<double, 4> value{};
    figure_(beside, value);
    const auto k = static_cast<std::size_t>(std::ranges::max_element(value) - value.begin());
    if (value[k] > here.value) {
      here = {value[k], beside[k]};
      continue;
    }
    along *= 0.5;
    across *= 0.5;
  }
  keep(here);
}

/// Returns its four parts, divided along the cut, across the wall or both, where a figure may
/// change most. Each halving keeps the slopes.
std::array<Cell, 4> Largest::quartered(const Cell& cell) const {
  constexpr double kSteeper = 2.0;
  const bool along = cell.grows_along() > kSteeper * cell.grows_across();
  const bool across = cell.grows_across() > kSteeper * cell.grows_along();
  const std::size_t n = along ? 4 : across ? 1 : 2, m = 4 / n;
  std::array<double, 15> value{};  // of samples, (m + 1) on each line
  std::array<SurfacePoint, 6> points{};
  std::array<std::size_t, 6> at{};
  std::size_t news = 0;
  const auto point = [&](std::size_t i, std::size_t j) {
    const double u = static_cast<double>(i) / static_cast<double>(n);
    const double v = static_cast<double>(j) / static_cast<double>(m);
    return SurfacePoint{cell.from.row, mixed(cell.from.u, cell.u1, u),
                        mixed(cell.from.v, cell.v1, v), cell.from.land};
  };
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t j = 0; j <= m; ++j) {
      const auto k = i * (m + 1) + j;
      const bool corner = (i == 0 || i == n) && (j == 0 || j == m);
      if (corner) value[k] = cell.value[(i == n ? 2U : 0U) + (j == m ? 1U : 0U)];
      if (corner) continue;
      points[news] = point(i, j);
      at[news++] = k;
    }
  std::array<double, 6> figures{};
  figure_(std::span(points).first(news), figures);
  for (std::size_t k = 0; k < news; ++k) value[at[k]] = figures[k];
  std::array<Cell, 4> out{cell, cell, cell, cell};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      auto& part = out[i * m + j];
      const auto k = i * (m + 1) + j, next = k + m + 1;
      part.from = point(i, j);
      const auto end = point(i + 1, j + 1);
      part.u1 = end.u;
      part.v1 = end.v;
      part.value = {value[k], value[k + 1], value[next], value[next + 1]};
      part.along /= static_cast<double>(n);
      part.across /= static_cast<double>(m);
      set_slopes(part, kKept * kKept, slope_along(part), slope_across(part));
      set_most(part);
    }
  return out;
}

}  // namespace tubecut::bevel::beam
