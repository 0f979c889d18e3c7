#include "core/bevel/beam.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2.0 * kRadPerDeg;  // over which a helix is a parabola: 1e-6 of the radius
constexpr double kSwing =
    3.0 * kRadPerDeg;               // over which the squared distance is all but a parabola
constexpr double kPlaces = 2000.0;  // along the cut, beside the rows and their middles
constexpr double kApart = 0.1;      // rad: leans that are apart
constexpr double kFine = 0.25;      // of half a kerf: across the wall, where they are
constexpr double kMostLines = 48;
constexpr int kFewest = 2, kMost = 8;  // stretches across the wall
constexpr double kArc = 1.01;          // no longer than that is an arc over its chord
constexpr double kMostParts = 64.0;    // of the way from row to row, each no longer than four kerfs
constexpr double kTiny = 1e-300;
constexpr int kParabolas = 4;
constexpr double kStill = 1e-4;      // of a stretch
constexpr double kRounding = 2e-6;   // of the radius, of a parabola for a helix
constexpr int kHalvings = 250;       // at most, of cells between places; most cuts need some ten
constexpr int kHalvingsOfRows = 40;  // likewise, where no more than what is there is asked for
constexpr double kKept = 0.8;        // of a cell's slope, by its halves
constexpr double kMargin = 4.0;      // times a slope that corners show: a ridge between them
constexpr double kTold = 2e-3;       // mm: a cell that promises no more than this is left alone,
constexpr double kToldShare = 8e-3;  // nor one that promises only so much of what is known

double mixed(double a, double b, double u) { return (1.0 - u) * a + u * b; }
Vector3d mixed(const Vector3d& a, const Vector3d& b, double u) { return (1.0 - u) * a + u * b; }

Vector3d placed(double radius, double phi, double z) {
  const auto at = elementary::sincos(phi);
  return {radius * at.cos, radius * at.sin, z};
}

AcrossWall mixed(const AcrossWall& a, const AcrossWall& b, double u) {
  return {mixed(a.phi_inner, b.phi_inner, u), mixed(a.z_inner, b.z_inner, u),
          mixed(a.phi_outer, b.phi_outer, u), mixed(a.z_outer, b.z_outer, u)};
}

/// Rows are joined the last to the first.
AcrossWall between(const std::vector<AcrossWall>& rows, double turn, std::size_t i, double u) {
  auto b = rows[(i + 1) % rows.size()];
  if (i + 1 == rows.size()) {
    b.phi_inner += turn;
    b.phi_outer += turn;
  }
  return mixed(rows[i], b, u);
}

/// The nearest axis: its squared distance, and the share of the way after `row` where it stands.
struct Nearest {
  double square;
  Vector3d point;  // of the axis, nearest
  std::size_t row;
  double u;
};

/// A straight stretch of the torch's way in phase and height, short enough to be a parabola in
/// space: the axis at the share x of it is inner(x) + s across(x). It comes from outside and is
/// looked at no further than the middle of the tube.
struct Stretch {
  std::size_t row;
  double from, to;  // shares of the way from this row to the next
  std::array<Vector3d, 3> inner, across;
  double middle;  // s where the tube's middle is
  double travel;  // no point of the axis moves further, as far beyond the walls as the kerf is wide

  [[nodiscard]] Vector3d at(double x, const Vector3d& q) const {
    const Vector3d p = inner[0] + x * (inner[1] + x * inner[2]);
    const Vector3d d = across[0] + x * (across[1] + x * across[2]);
    return p + std::max((q - p).dot(d) / d.squaredNorm(), middle) * d;
  }
  [[nodiscard]] double square(double x, const Vector3d& q) const {
    return (q - at(x, q)).squaredNorm();
  }
};

/// The axes along the torch's way; indices over two laps, so that half a lap either way is a run.
class Beam {
 public:
  Beam(const BeamCut& cut, const std::stop_token& stop) : cut_(cut) {
    const auto n = cut.torch.size();
    for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
      first_.push_back(stretches_.size());
      const auto a = torch(i, 0.0), b = torch(i, 1.0);
      const double wide =
          std::max(std::abs(b.phi_inner - a.phi_inner), std::abs(b.phi_outer - a.phi_outer));
      const double rise =
          std::max(std::abs(b.z_inner - a.z_inner), std::abs(b.z_outer - a.z_outer));
      const double way = std::min(rise + cut.outer * wide, 4.0 * kMostParts * cut.kerf);
      const auto from = axis(a), to = axis(b);
      const double swing = elementary::atan2(from.cross(to).norm(), from.dot(to));
      const int parts = 1 + static_cast<int>(std::max(
                                {wide / kTurn, way / (4.0 * cut.kerf + kTiny), swing / kSwing}));
      for (int k = 0; k < parts; ++k)
        add(i, static_cast<double>(k) / parts, static_cast<double>(k + 1) / parts);
    }
    first_.push_back(stretches_.size());
    travelled_.push_back(0.0);
    for (std::size_t k = 0; k < 2 * stretches_.size(); ++k)
      travelled_.push_back(travelled_.back() + stretches_[k % stretches_.size()].travel);
  }

  /// To q, from the axes less than half a lap from the share u of the way after `row`.
  [[nodiscard]] Nearest nearest(std::size_t row, double u, const Vector3d& q) const {
    const auto n = stretches_.size();
    std::size_t start = first_[row];
    while (start + 1 < first_[row + 1] && stretches_[start + 1].from <= u) ++start;
    const auto& own = stretches_[start];
    Best best{start, std::clamp((u - own.from) / (own.to - own.from), 0.0, 1.0)};
    best.square = own.square(best.x, q);
    best.distance = std::sqrt(best.square);
    walk(start, start + n / 2, q, best);
    walk_back(start + n, start + n - n / 2, q, best);
    const auto& s = stretches_[best.stretch];
    return {best.square, s.at(best.x, q), s.row, mixed(s.from, s.to, best.x)};
  }

 private:
  [[nodiscard]] AcrossWall torch(std::size_t row, double u) const {
    return between(cut_.torch, cut_.turn, row, u);
  }

  [[nodiscard]] Vector3d axis(const AcrossWall& at) const {
    return placed(cut_.outer, at.phi_outer, at.z_outer) -
           placed(cut_.inner, at.phi_inner, at.z_inner);
  }

  void add(std::size_t row, double from, double to) {
    Stretch out{.row = row, .from = from, .to = to};
    std::array<Vector3d, 3> in, over;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto t = torch(row, mixed(from, to, 0.5 * static_cast<double>(k)));
      in[k] = placed(cut_.inner, t.phi_inner, t.z_inner);
      over[k] = placed(cut_.outer, t.phi_outer, t.z_outer) - in[k];
    }
    out.inner = {in[0], 4.0 * in[1] - 3.0 * in[0] - in[2], 2.0 * (in[0] - 2.0 * in[1] + in[2])};
    out.across = {over[0], 4.0 * over[1] - 3.0 * over[0] - over[2],
                  2.0 * (over[0] - 2.0 * over[1] + over[2])};
    out.middle = -cut_.inner / (cut_.outer - cut_.inner);
    const double inner = (in[2] - in[0]).norm(), outer = (in[2] + over[2] - in[0] - over[0]).norm();
    const double beyond = cut_.kerf / over[0].norm() * (over[2] - over[0]).norm();
    out.travel = kArc * (std::max(inner, outer) + beyond);
    stretches_.push_back(out);
  }

  struct Best {
    std::size_t stretch;
    double x;
    double square = 0.0, distance = 0.0;

    void see(std::size_t k, double at, double value) {
      if (value >= square) return;
      *this = {k, at, value, std::sqrt(value)};
    }
  };
  [[nodiscard]] const Stretch& stretch(std::size_t k) const {
    return stretches_[k % stretches_.size()];
  }

  /// Stretches ahead. Where the axes are further away than the best one, none nearer comes before
  /// they have travelled as much.
  void walk(std::size_t k, std::size_t last, const Vector3d& q, Best& best) const {
    double low = stretch(k).square(0.0, q);
    while (k <= last) {
      const double high = stretch(k).square(1.0, q), far = std::sqrt(high);
      look(k, low, high, std::sqrt(low) + far, q, best);
      const double clear = travelled_[k + 1] + std::max(0.0, far - best.distance);
      if (travelled_[k + 2] > clear) {
        ++k;
        low = high;
        continue;
      }
      const auto past = std::ranges::upper_bound(travelled_, clear) - travelled_.begin();
      k = static_cast<std::size_t>(past) - 1;
      low = stretch(k).square(0.0, q);
    }
  }
  /// Stretches behind `end`, likewise.
  void walk_back(std::size_t end, std::size_t first, const Vector3d& q, Best& best) const {
    double high = stretch(end).square(0.0, q);
    while (end > first) {
      const auto k = end - 1;
      const double low = stretch(k).square(0.0, q), far = std::sqrt(low);
      look(k, low, high, far + std::sqrt(high), q, best);
      const double clear = travelled_[k] - std::max(0.0, far - best.distance);
      if (k == 0 || travelled_[k - 1] < clear) {
        end = k;
        high = low;
        continue;
      }
      const auto from = std::ranges::lower_bound(travelled_, clear) - travelled_.begin();
      end = static_cast<std::size_t>(from);
      high = stretch(end).square(0.0, q);
    }
  }

  /// Along one stretch, if a nearer axis could be in it: the squared distance is all but a
  /// parabola. `both` is the sum of the distances at its ends.
  void look(std::size_t index, double low, double high, double both, const Vector3d& q,
            Best& best) const {
    const auto k = index % stretches_.size();
    const auto& s = stretches_[k];
    best.see(k, 0.0, low);
    best.see(k, 1.0, high);
    if (0.5 * (both - s.travel) >= best.distance) return;
    const double middle = s.square(0.5, q);
    const double bend = low - 2.0 * middle + high;
    const double x = 0.25 * (3.0 * low - 4.0 * middle + high) / bend;
    if (!(bend > 0.0 && x > 0.0 && x < 1.0)) return best.see(k, 0.5, middle);
    descend(k, x, q, best);
  }

  /// From near the least squared distance of a stretch to it, by parabolas through three places.
  void descend(std::size_t k, double x, const Vector3d& q, Best& best) const {
    const auto& s = stretches_[k];
    double beside = 0.05;  // of the stretch
    for (int round = 0; round < kParabolas; ++round, beside *= 0.2) {
      const double here = s.square(x, q);
      best.see(k, x, here);
      const double before = s.square(x - beside, q), after = s.square(x + beside, q);
      const double bend = before - 2.0 * here + after;
      if (!(bend > 0.0)) return;
      const double step = 0.5 * beside * (before - after) / bend;
      x = std::clamp(x + step, 0.0, 1.0);
      if (std::abs(step) < kStill) break;
    }
    best.see(k, x, s.square(x, q));
  }

  const BeamCut& cut_;
  std::vector<Stretch> stretches_;
  std::vector<std::size_t> first_;  // stretch of each row
  std::vector<double> travelled_;   // to the start of the stretch, of all before it
};

/// A place of the finished surface: between rows, across the wall.
struct Place {
  std::size_t row = 0;
  double u = 0.0, v = 0.0;
  bool land = false;
};

class Surface {
 public:
  Surface(const BeamCut& cut, const std::stop_token& stop) : cut_(cut), beam_(cut, stop) {
    for (std::size_t i = 0; i < rows() && !stop.stop_requested(); ++i) along_.push_back(way(i));
  }

  /// Distance from the nearest axis; negative where that runs beyond the finished line of its own
  /// row, in the part.
  [[nodiscard]] double distance(const Place& at) const {
    const auto near = beam_.nearest(at.row, at.u, point(at));
    const double distance = std::sqrt(near.square);
    return beyond(near) > kRounding * cut_.outer ? -distance : distance;
  }

  [[nodiscard]] double phase(const Place& at) const {
    const auto here = finished(at);
    return mixed(here.phi_inner, here.phi_outer, at.land ? 0.0 : share(at));
  }
  [[nodiscard]] std::size_t rows() const { return cut_.finished.size(); }
  [[nodiscard]] double across(std::size_t row, bool land) const {
    return (point({row, 0.0, 1.0, land}) - point({row, 0.0, 0.0, land})).norm();
  }
  /// Length of the way from one row to the next, on the wall where it is longer.
  [[nodiscard]] double step(std::size_t row) const {
    const auto a = finished({row, 0.0}), b = finished({row, 1.0});
    const double rise = b.z_inner - a.z_inner;
    const double land = cut_.land.empty() ? rise : cut_.land[(row + 1) % rows()] - cut_.land[row];
    const double steep = std::max(std::abs(rise), std::abs(land));
    return std::max(
        elementary::hypot(cut_.inner * (b.phi_inner - a.phi_inner), steep),
        elementary::hypot(cut_.outer * (b.phi_outer - a.phi_outer), b.z_outer - a.z_outer));
  }

 private:
  [[nodiscard]] double share(const Place& at) const { return mixed(cut_.from, 1.0, at.v); }
  [[nodiscard]] AcrossWall finished(const Place& at) const {
    return between(cut_.finished, cut_.turn, at.row, at.u);
  }
  [[nodiscard]] Vector3d point(const Place& at) const {
    const auto here = finished(at);
    const Vector3d inner = placed(cut_.inner, here.phi_inner, here.z_inner);
    const Vector3d outer = placed(cut_.outer, here.phi_outer, here.z_outer);
    if (!at.land) return mixed(inner, outer, share(at));
    const double z = mixed(cut_.land[at.row], cut_.land[(at.row + 1) % rows()], at.u);
    return mixed(placed(cut_.inner, here.phi_inner, z), mixed(inner, outer, cut_.from), at.v);
  }
  /// How far the axis runs beyond the finished line of its own row where it is nearest.
  [[nodiscard]] double beyond(const Nearest& near) const {
    const auto own = finished({near.row, near.u});
    const Vector3d inner = placed(cut_.inner, own.phi_inner, own.z_inner);
    const Vector3d across = placed(cut_.outer, own.phi_outer, own.z_outer) - inner;
    const Vector3d from = near.point - inner;
    const Vector3d off = from - from.dot(across) / across.squaredNorm() * across;
    const Vector3d normal = along_[near.row].cross(across);
    const double size = normal.norm();
    return size > 0.0 ? (cut_.part_to_the_left ? -1.0 : 1.0) * normal.dot(off) / size : 0.0;
  }
  /// The finished surface's way from a row to the next, in the middle of the wall.
  [[nodiscard]] Vector3d way(std::size_t row) const {
    const auto a = finished({row, 0.0}), b = finished({row, 1.0});
    return 0.5 * (placed(cut_.inner, b.phi_inner, b.z_inner) -
                  placed(cut_.inner, a.phi_inner, a.z_inner) +
                  placed(cut_.outer, b.phi_outer, b.z_outer) -
                  placed(cut_.outer, a.phi_outer, a.z_outer));
  }

  const BeamCut& cut_;
  Beam beam_;
  std::vector<Vector3d> along_;  // after each row
};

/// How far the surface is short of half a kerf from the nearest axis (`sign` -1) or beyond it (1).
struct Figure {
  const Surface& surface;
  double half, sign;

  [[nodiscard]] double operator()(const Place& at) const {
    return sign * (surface.distance(at) - half);
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
  [[nodiscard]] double most() const {
    return *std::ranges::max_element(value) + 0.5 * (grows_along() + grows_across());
  }
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

/// The largest figure: the cell that promises most is halved until none promises more than is
/// known, or for as long as is granted.
class Largest {
 public:
  explicit Largest(const Figure& figure) : figure_(figure) {}

  void see(const Cell& cell) {
    cells_.push_back(with_slopes(cell, kMargin));
    keep(cell);
  }

  [[nodiscard]] Seen worst(int halvings) {
    std::ranges::make_heap(cells_, {}, &Cell::most);
    while (halvings-- > 0 && !cells_.empty()) {
      std::ranges::pop_heap(cells_, {}, &Cell::most);
      const Cell cell = cells_.back();
      cells_.pop_back();
      const double known = std::max(0.0, best_.value);
      if (!(cell.most() > known + std::max(kTold, kToldShare * known))) break;
      for (const auto& half : halved(cell, cell.grows_along() > cell.grows_across())) {
        keep(half);
        cells_.push_back(with_slopes(half, kKept));
        std::ranges::push_heap(cells_, {}, &Cell::most);
      }
    }
    return best_;
  }

 private:
  void keep(const Cell& cell) {
    const auto k =
        static_cast<std::size_t>(std::ranges::max_element(cell.value) - cell.value.begin());
    if (!(cell.value[k] > best_.value)) return;
    best_ = {cell.value[k], cell.from};
    if (k & 1U) best_.at.v = cell.v1;
    if (k & 2U) best_.at.u = cell.u1;
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
  std::vector<Cell> cells_;
  Seen best_;
};

/// Runs of rows near which, within half a kerf, the torch leans in ways that are apart: there a
/// place where the beam is in the part can be narrow across the wall.
std::vector<std::pair<std::size_t, std::size_t>> swings(const BeamCut& cut, const Surface& surface,
                                                        const std::stop_token& stop) {
  const auto n = surface.rows();
  std::vector<double> leans, steps;
  for (std::size_t i = 0; i < n; ++i) {
    const auto &a = cut.torch[i], &b = cut.torch[(i + 1) % n];
    const double turn = i + 1 == n ? cut.turn : 0.0;
    leans.push_back(elementary::atan2(a.z_outer - a.z_inner, cut.outer - cut.inner));
    steps.push_back(cut.inner * std::abs(b.phi_inner + turn - a.phi_inner));
  }
  std::vector<bool> near(n, false);
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
    double low = leans[i], high = low, left = 0.5 * cut.kerf;  // to look ahead
    std::size_t k = i;
    for (; k < i + n && left > 0.0; ++k) {
      const double there =
          mixed(leans[k % n], leans[(k + 1) % n], std::min(1.0, left / (steps[k % n] + kTiny)));
      low = std::min(low, there);
      high = std::max(high, there);
      left -= steps[k % n];
    }
    if (high - low < kApart) continue;
    for (std::size_t m = i + n - 1; m < k + n; ++m) near[m % n] = true;
  }
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 0; i < n; ++i) {
    if (!near[i]) continue;
    if (out.empty() || out.back().second != i) out.emplace_back(i, i);
    out.back().second = i + 1;
  }
  return out;
}

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
    for (int m = 0; m <= grid.lines; ++m) here.push_back(figure({row, u, share(m), grid.land}));
  };
  line_up(grid.first, 0.0);
  for (std::size_t i = grid.first; i < grid.end && !stop.stop_requested(); ++i) {
    const double step = surface.step(i), wide = surface.across(i, grid.land) / grid.lines;
    const int parts = std::max(1, static_cast<int>(std::ceil(step / grid.apart)));
    for (int k = 0; k < parts; ++k) {
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

}  // namespace

BeamProof beam_proof(const BeamCut& cut, Places places, const std::stop_token& stop) {
  const Surface surface(cut, stop);
  if (stop.stop_requested()) return {};
  const double half = 0.5 * cut.kerf;
  const bool rows_only = places == Places::rows;
  double length = 0.0;
  for (std::size_t i = 0; i < surface.rows(); ++i) length += surface.step(i);
  const Figure short_of{surface, half, -1.0}, beyond{surface, half, 1.0};
  Largest gouges(short_of), lefts(beyond);
  const auto see = [&](Cell cell) {
    gouges.see(cell);
    if (cell.from.land) return;
    for (double& value : cell.value) value = -value;
    lefts.see(cell);
  };
  Grid grid{.apart = rows_only || half == 0.0 ? length : std::max(0.5 * half, length / kPlaces),
            .lines = rows_only ? 1 : lines(cut),
            .first = 0,
            .end = surface.rows()};
  see_cells(short_of, grid, stop, see);
  grid.land = true;
  if (!cut.land.empty()) see_cells(short_of, grid, stop, see);
  grid.land = false;
  grid.lines = static_cast<int>(
      std::clamp((cut.outer - cut.inner) / (kFine * half + kTiny), 1.0 * lines(cut), kMostLines));
  if (!rows_only && half > 0.0)
    for (const auto& [first, end] : swings(cut, surface, stop)) {
      grid.first = first;
      grid.end = end;
      see_cells(short_of, grid, stop, see);
    }
  const int halvings = rows_only ? kHalvingsOfRows : kHalvings;
  const auto gouge = gouges.worst(halvings), left = lefts.worst(halvings);
  BeamProof out{.gouge = std::max(0.0, gouge.value),
                .gouge_phi = surface.phase(gouge.at),
                .left = std::max(0.0, left.value),
                .left_phi = surface.phase(left.at)};
  if (rows_only) return out;
  const auto rows = beam_proof(cut, Places::rows, stop);  // what is stated is no less than it
  if (rows.gouge > out.gouge)
    std::tie(out.gouge, out.gouge_phi) = std::tie(rows.gouge, rows.gouge_phi);
  if (rows.left > out.left) std::tie(out.left, out.left_phi) = std::tie(rows.left, rows.left_phi);
  return out;
}

}  // namespace tubecut::bevel
