#include "core/bevel/beam/beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/beam/beam_cells.hpp"
#include "core/bevel/beam/beam_surface.hpp"
#include "core/bevel/beam/beam_swings.hpp"

namespace tubecut::bevel {
namespace {

using beam::Cell;
using beam::Figure;
using beam::kMargin;
using beam::Largest;
using beam::Line;
using beam::set_slopes;
using beam::slope_across;
using beam::slope_along;
using beam::Surface;
using beam::SurfacePoint;

constexpr double kPlaces = 2000.0;  // along the cut, in addition to the rows and their middles
constexpr double kFine = 0.25;      // of half a kerf: across the wall, distance of points
constexpr double kMostLines = 48;
constexpr int kFewest = 2, kMost = 8;  // intervals across the wall
constexpr int kFiner = 3;              // in each direction, for cuts that bend
constexpr double kTiny = 1e-300;
constexpr int kHalvings = 250;       // at most, of cells between samples; most cuts need some ten
constexpr int kHalvingsOfRows = 40;  // likewise, if only the rows are requested

struct Grid {
  double apart;            // mm, along the cut
  int lines;               // intervals across the wall
  std::size_t first, end;  // rows
  bool land = false;
};

/// A line of the grid, and the fraction of the path after its row at which its cells end.
struct GridLine {
  std::size_t row;
  double u, u1;
  double along, across;  // of a cell, mm
};

/// Passes all cells of a grid with their figures to `see`, line by line.
template <class See>
class Cells {
 public:
  Cells(const Figure& figure, const Grid& grid, const See& see)
      : figure_(figure), grid_(grid), see_(see), last_(size() - 1) {}

  /// Processes up to kLanes lines of the grid; cells end at each except the very first.
  void line_up(std::span<const GridLine> lines) {
    std::array<SurfacePoint, beam::kLanes> ends{};
    std::array<Line, beam::kLanes> across;
    for (std::size_t k = 0; k < lines.size(); ++k)
      ends[k] = {lines[k].row, lines[k].u1, 0.0, grid_.land};
    figure_.surface.across_wall(std::span(ends).first(lines.size()), across);
    points_.clear();
    on_.clear();
    for (std::size_t k = 0; k < lines.size(); ++k)
      for (std::size_t m = 0; m < size(); ++m) {
        points_.push_back({ends[k].row, ends[k].u, share(m), grid_.land});
        on_.push_back(across[k]);
      }
    here_.resize(points_.size());
    for (std::size_t k = 0; k < points_.size(); k += beam::kLanes) {
      const auto n = std::min(beam::kLanes, points_.size() - k);
      figure_.of(std::span(points_).subspan(k, n), std::span(on_).subspan(k, n),
                 std::span(here_).subspan(k, n));
    }
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const auto figures = std::span(here_).subspan(k * size(), size());
      if (!before_.empty()) see_cells(lines[k], figures);
      before_.assign(figures.begin(), figures.end());
    }
  }

 private:
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(grid_.lines) + 1; }
  [[nodiscard]] double share(std::size_t m) const { return static_cast<double>(m) / grid_.lines; }

  void see_cells(const GridLine& line, std::span<const double> here) {
    for (std::size_t m = 0; m + 1 < size(); ++m) {
      Cell cell{.from = {line.row, line.u, share(m), grid_.land},
                .u1 = line.u1,
                .v1 = share(m + 1),
                .value = {before_[m], before_[m + 1], here[m], here[m + 1]},
                .along = line.along,
                .across = line.across,
                .steep_along = last_[m].along,
                .steep_across = last_[m].across};
      last_[m] = {slope_along(cell), slope_across(cell)};
      set_slopes(cell, kMargin, last_[m].along, last_[m].across);
      see_(cell);
    }
  }

  struct Slopes {
    double along = 0.0, across = 0.0;
  };
  const Figure& figure_;
  const Grid& grid_;
  const See& see_;
  std::vector<Slopes> last_;          // of the cells before
  std::vector<double> before_;        // figures on the line before
  std::vector<SurfacePoint> points_;  // on the lines in progress
  std::vector<Line> on_;
  std::vector<double> here_;
};

/// Passes all cells of the grid, with their figures, to `see`.
template <class See>
void see_cells(const Figure& figure, const Grid& grid, const See& see) {
  const auto& surface = figure.surface;
  Cells cells(figure, grid, see);
  std::vector<GridLine> lines{{grid.first, 0.0, 0.0, 0.0, 0.0}};
  const auto hand_over = [&] {
    cells.line_up(lines);
    lines.clear();
  };
  for (std::size_t i = grid.first; i < grid.end && !stopped(); ++i) {
    const double step = surface.step(i), wide = surface.across(i, grid.land) / grid.lines;
    const int parts = std::max(1, static_cast<int>(std::ceil(step / grid.apart)));
    for (int k = 0; k < parts && !stopped(); ++k) {
      const double u = static_cast<double>(k) / parts, u1 = static_cast<double>(k + 1) / parts;
      lines.push_back({i, u, u1, step / parts, wide});
      if (lines.size() == beam::kLanes) hand_over();
    }
  }
  if (!lines.empty() && !stopped()) hand_over();
}

/// Returns the number of intervals across the wall: more if the wall is thick compared with the
/// kerf.
int lines(const BeamCut& cut) {
  constexpr double kKerfs = 4.0;
  if (cut.kerf == 0.0) return kFewest;
  const double parts = std::ceil((cut.outer - cut.inner) / (kKerfs * cut.kerf + kTiny));
  return static_cast<int>(std::clamp(parts, 1.0 * kFewest, 1.0 * kMost));
}

/// Raises the results everywhere to those at the rows, because the verification reads the rows.
void raise_to_rows(const BeamFound& rows, BeamFound& all) {
  auto& [proof, gouged_from] = all;
  if (rows.proof.gouge > proof.gouge)
    std::tie(proof.gouge, proof.gouge_phi) = std::tie(rows.proof.gouge, rows.proof.gouge_phi);
  if (rows.proof.left > proof.left)
    std::tie(proof.left, proof.left_phi) = std::tie(rows.proof.left, rows.proof.left_phi);
  std::ranges::transform(gouged_from, rows.gouged_from, gouged_from.begin(),
                         [](double a, double b) { return std::max(a, b); });
}

BeamFound found_at(const BeamCut& cut, const Surface& surface, SampleDensity density) {
  BeamFound out{.gouged_from = std::vector<double>(cut.torch.size(), 0.0)};
  if (stopped()) return out;
  const double half = 0.5 * cut.kerf;
  const bool rows_only = density == SampleDensity::rows;
  double length = 0.0;
  for (std::size_t i = 0; i < surface.rows(); ++i) length += surface.step(i);
  const Figure short_of{surface, half, -1.0, &out.gouged_from}, beyond{surface, half, 1.0};
  Largest gouges(short_of), lefts(beyond);
  const auto see = [&](const Cell& cell) {
    gouges.see(cell, 1.0);
    if (!cell.from.land) lefts.see(cell, -1.0);
  };
  const int finer = density == SampleDensity::finely ? kFiner : 1;
  Grid grid{
      .apart = rows_only || half == 0.0 ? length : std::max(0.5 * half, length / kPlaces) / finer,
      .lines = rows_only ? 1 : finer * lines(cut),
      .first = 0,
      .end = surface.rows()};
  see_cells(short_of, grid, see);
  grid.land = true;
  if (!cut.land.empty()) see_cells(short_of, grid, see);
  grid.land = false;
  grid.lines = static_cast<int>(
      std::clamp((cut.outer - cut.inner) / (kFine * half + kTiny), 1.0 * lines(cut), kMostLines));
  if (!rows_only && half > 0.0)
    for (const auto& [first, end] : beam::swings(cut)) {
      grid.first = first;
      grid.end = end;
      see_cells(short_of, grid, see);
    }
  if (stopped()) return out;
  const int halvings = rows_only ? kHalvingsOfRows : kHalvings;
  const auto gouge = gouges.worst(halvings), left = lefts.worst(halvings);
  out.proof = {.gouge = std::max(0.0, gouge.value),
               .gouge_phi = surface.phase(gouge.at),
               .left = std::max(0.0, left.value),
               .left_phi = surface.phase(left.at)};
  return out;
}

}  // namespace

BeamFound beam_found(const BeamCut& cut, SampleDensity density) {
  if (cut.kerf == 0.0 && cut.land.empty() && cut.torch == cut.finished)
    return {.gouged_from = std::vector<double>(cut.torch.size(), 0.0)};
  const Surface surface(cut);
  auto out = found_at(cut, surface, density);
  if (density != SampleDensity::rows)
    raise_to_rows(found_at(cut, surface, SampleDensity::rows), out);
  return out;
}

BeamProof clear_torch(std::size_t rows, const std::function<BeamCut(const Further&)>& cut) {
  constexpr double kAimed =
      0.7 * kGougeLimit;  // because slightly more may be removed than is found
  constexpr double kMore =
      1.25;  // because the distance to the surface grows less than the torch moves
  constexpr int kRounds = 8;
  Further further(rows, 0.0);
  for (int round = 0;; ++round) {
    const auto moved = cut(further);
    const bool bends = round > 0 && moved.turn == 0.0;  // the drop of an end is already the minimum
    const auto found = beam_found(moved, bends ? SampleDensity::finely : SampleDensity::everywhere);
    if (!(found.proof.gouge > kAimed) || round == kRounds || stopped()) return found.proof;
    for (std::size_t i = 0; i < rows; ++i) further[i] += kMore * found.gouged_from[i];
    if (std::ranges::max(further) > moved.kerf) return found.proof;
  }
}

}  // namespace tubecut::bevel
