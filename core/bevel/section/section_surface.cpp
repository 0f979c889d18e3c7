#include "core/bevel/section/section_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/joint/solid.hpp"
#include "core/math/dome.hpp"
#include "core/math/mixed.hpp"
#include "core/math/search.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr int kAlong = 14;         // places within reach of the beam, to each side
constexpr int kAcross = 4;         // parts of the wall
constexpr double kMargin = 0.008;  // of half a kerf: five times what the grid may fall short
constexpr double kClose = 0.05;    // of half a kerf: about the best place, a last search
constexpr int kGoldenSteps =
    10;                    // the bracket shrinks to 1/120, the need is good to 1e-6 of a kerf
constexpr int kInGap = 8;  // parts of a gap between rows
constexpr int kInGapRounds = 3;
constexpr double kShallow = 1e-3;  // mm: how far inside a partner more rounds are worth

}  // namespace

double SectionSurface::width(std::size_t row) const {
  const double step = table_.at[next(row)].s - table_.at[row].s;
  return next(row) == 0 ? step + table_.girth : step;
}

SectionSurface::Line SectionSurface::line(std::size_t row, double share) const {
  const auto j = next(row);
  const auto mixed = [&](const std::vector<double>& z) { return math::mixed(z[row], z[j], share); };
  Line out;
  if (share == 0.0 || share == 1.0) {
    const auto k = share == 0.0 ? row : j;
    out.at = table_.at[k];
    out.wall = table_.wall[k];
  } else {
    out.at = wall_.outer().after(table_.at[row], share * width(row));
    out.wall = wall_.thickness(out.at);
  }
  out.inner = mixed(table_.z_inner);
  out.outer = mixed(table_.z_outer);
  out.face = table_.z_face.empty() ? out.inner : mixed(table_.z_face);
  out.foot = out.inner;
  if (table_.z_face.empty()) return out;
  const auto foot = [&](std::size_t k) {
    return table_.z_face[k] - spec_.root_face * elementary::tan(table_.b[k]);
  };
  out.foot = math::mixed(foot(row), foot(j), share);
  return out;
}

SectionSurface::Line SectionSurface::line_at(std::size_t row, double s) const {
  const double wide = width(row);
  double off = s - table_.at[row].s;
  if (off < 0.0) off += table_.girth;
  return line(row, wide > 0.0 ? std::clamp(off / wide, 0.0, 1.0) : 0.0);
}

std::size_t SectionSurface::row_before(double s) const {
  const auto after =
      std::ranges::upper_bound(table_.at, s, {}, [](const section::Station& a) { return a.s; });
  return after == table_.at.begin() ? table_.at.size() - 1
                                    : static_cast<std::size_t>(after - table_.at.begin()) - 1;
}

bool SectionSurface::flat_around(const section::Station& at, double reach) const {
  if (at.on_corner) return false;
  const double half = std::min(wall_.outer().half_flat(at.face), wall_.bore().half_flat(at.face));
  return std::abs(at.along) + reach <= half;
}

double SectionSurface::beam_reach(double kerf) const {
  constexpr double kBunched = 2.6;  // kerfs, where lines bunch on a bore that is not concentric
  const double half = 0.5 * kerf, radius = wall_.outer().corner();
  if (!wall_.concentric()) return kBunched * kerf;
  // A place on the bore lies within half a kerf of the beam's plane; beyond a quarter turn it turns
  // away.
  const double bore = radius - wall_.section().wall;
  return half < bore ? std::max(half, radius * elementary::asin(half / bore)) : kBunched * kerf;
}

double SectionSurface::z(const Line& line, double depth) const {
  // Because rounding may make the wall thinner than the depth of its own bore.
  const double from_bore = std::max(0.0, line.wall - depth);  // outwards
  if (from_bore >= land())
    return math::mixed(line.face, line.outer, (from_bore - land()) / (line.wall - land()));
  return math::mixed(line.inner, line.face, from_bore / land());
}

namespace {

/// Returns the drop at a place around which, within half a kerf, the outside and the bore are flat:
/// there the wall has one thickness, and the surface between two rows is ruled over straight edges.
/// At a depth, the need of such a strip is largest at a place with a closed form. For each place it
/// is linear in the depth, so its largest value is convex in the depth: it lies at an edge of the
/// wall, or of the land.
/// Accuracy  exact within rounding.
double drop_on_flat(const SectionSurface& surface, const SectionSurface::Line& own, std::size_t row,
                    double kerf) {
  const double half = 0.5 * kerf, slope = own.slope();
  const double secant = elementary::hypot(1.0, slope);
  double best = 0.0;
  surface.rows_near(row, kerf, [&](std::size_t i) {
    const auto from = surface.line(i, 0.0), to = surface.line(i, 1.0);
    const double a = std::remainder(from.at.s - own.at.s, surface.wall().outer().girth());
    const double b = a + surface.width(i);
    const double low = std::max(a, -half), high = std::min(b, half);
    if (!(low <= high)) return;
    const auto see = [&](double depth, double z_a, double z_b) {
      const double rise = b > a ? (z_b - z_a) / (b - a) : 0.0;
      const double u = std::clamp(-rise * half / elementary::hypot(secant, rise), low, high);
      const double z = b > a ? z_a + rise * (u - a) : std::min(z_a, z_b);
      best = std::max(best, own.outer - depth * slope - z +
                                std::sqrt(std::max(0.0, (half - u) * (half + u))) * secant);
    };
    see(0.0, from.outer, to.outer);
    see(own.wall - surface.land(), from.face, to.face);
    if (surface.land() > 0.0) see(own.wall, from.inner, to.inner);
  });
  return best;
}

/// Finds the drop that one place of the cut needs. Along a line across the wall the need is concave
/// on each side of the land's edge, with a closed form of its largest value; so only the way along
/// s is searched.
class Drop {
 public:
  Drop(const SectionSurface& surface, std::size_t row, double share, double kerf)
      : surface_(surface),
        own_(surface.line(row, share)),
        tangent_(own_.at.tangent()),
        slope_(own_.slope()),
        secant_(elementary::hypot(1.0, slope_)),
        half_(0.5 * kerf),
        deepest_(-(own_.wall + kerf)) {}

  double needed(std::size_t row) {
    const double reach = surface_.beam_reach(2.0 * half_);
    const auto grid = places(reach);
    std::vector<double> sampled;
    sampled.reserve(grid.size());
    for (const double s : grid) sampled.push_back(see(line_at(s)));
    refine(grid, sampled);
    // The surface has its edges' corners at rows: both of a jump count.
    surface_.rows_near(row, reach, [&](std::size_t i) { see(surface_.line(i, 0.0)); });
    along(best_s_ - kClose * half_, best_s_ + kClose * half_);
    return best_;
  }

 private:
  /// Ascending s: dense where the beam's circle is steep, further out where lines bunch.
  [[nodiscard]] std::vector<double> places(double reach) const {
    static const auto kSines = [] {
      std::array<double, 2 * kAlong + 1> sines{};
      for (int k = -kAlong; k <= kAlong; ++k)
        sines[static_cast<std::size_t>(k + kAlong)] = elementary::sin(0.5 * kPi * k / kAlong);
      return sines;
    }();
    std::vector<double> out;
    out.reserve(2 * kSines.size());
    for (const double sine : kSines) {
      out.push_back(own_.at.s + half_ * sine);
      if (reach * std::abs(sine) > half_) out.push_back(own_.at.s + reach * sine);
    }
    std::ranges::sort(out);
    return out;
  }

  /// Refines every maximum of the grid that may be the largest.
  void refine(const std::vector<double>& grid, const std::vector<double>& sampled) {
    const double margin = kMargin * half_ * secant_;  // by which the grid may fall short
    const auto n = grid.size();
    for (std::size_t k = 0; k < n; ++k) {
      const bool left = k == 0 || sampled[k] >= sampled[k - 1];
      const bool right = k + 1 == n || sampled[k] >= sampled[k + 1];
      if (left && right && sampled[k] > best_ - margin)
        along(grid[k == 0 ? 0 : k - 1], grid[k + 1 == n ? k : k + 1]);
    }
  }

  void along(double low, double high) {
    const auto most =
        math::golden_maximum<kGoldenSteps>([&](double s) { return need(line_at(s)); }, low, high);
    see(line_at(most.at));
  }

  [[nodiscard]] SectionSurface::Line line_at(double s) const {
    const double girth = surface_.wall().outer().girth();
    const double there = s - girth * std::floor(s / girth);
    return surface_.line_at(surface_.row_before(there), there);
  }

  /// The largest need of a line across the wall.
  [[nodiscard]] double need(const SectionSurface::Line& line) const {
    const Eigen::Vector2d off = line.at.point - own_.at.point;
    const double u = off.dot(tangent_), v = off.dot(own_.at.normal);
    const double across = -line.at.normal.dot(tangent_), in = -line.at.normal.dot(own_.at.normal);
    double most = -kUnbounded;
    const auto see_part = [&](double from, double to, double z_from, double z_to) {
      const double rise = (z_to - z_from) / (to - from);
      const math::Dome dome{in * slope_ - rise, secant_, u, across, half_};
      // The metal of the wall's other side does not count.
      const double end = in < 0.0 ? std::min(to, (deepest_ - v) / in) : to;
      const double begin = in > 0.0 ? std::max(from, (deepest_ - v) / in) : from;
      const auto depth = math::highest(dome, begin, end);
      if (!depth || (in == 0.0 && v < deepest_)) return;
      most = std::max(most, own_.outer + v * slope_ - z_from + rise * from + dome.at(*depth));
    };
    const double edge = line.wall - surface_.land();
    see_part(0.0, edge, line.outer, line.face);
    if (surface_.land() > 0.0) see_part(edge, line.wall, line.face, line.inner);
    return most;
  }

  double see(const SectionSurface::Line& line) {
    const double value = need(line);
    if (value > best_) {
      best_ = value;
      best_s_ = line.at.s;
    }
    return value;
  }

  const SectionSurface& surface_;
  SectionSurface::Line own_;
  Eigen::Vector2d tangent_;
  double slope_, secant_, half_, deepest_;
  double best_ = -kUnbounded, best_s_ = 0.0;
};

}  // namespace

double needed_drop(const SectionSurface& surface, std::size_t row, double share, double kerf) {
  if (!(kerf > 0.0)) return 0.0;
  const auto own = surface.line(row, share);
  if (surface.flat_around(own.at, 0.5 * kerf)) return drop_on_flat(surface, own, row, kerf);
  return Drop(surface, row, share, kerf).needed(row);
}

SectionTable::Deepest deepest_in_gap(const SectionSurface& surface, std::size_t row,
                                     const std::vector<joint::Solid>& solids) {
  SectionTable::Deepest out{.depth = -kUnbounded};
  double across = 0.0;  // share of the wall, from the outside
  const auto see = [&](const SectionSurface::Line& line, double share) {
    const double depth = share * line.wall, z = surface.z(line, depth);
    const auto place = SectionSurface::place(line, depth, z);
    for (std::size_t k = 0; k < solids.size(); ++k) {
      const double in = -solids[k].distance(place);
      if (!(in > out.depth)) continue;
      out = {.depth = in, .s = line.at.s, .below = depth, .z = z, .solid = k};
      across = share;
    }
  };
  double deepest_share = 0.0;
  for (int k = 0; k < kInGap; ++k) {
    const auto line = surface.line(row, static_cast<double>(k) / kInGap);
    const double before = out.depth;
    for (int a = 0; a <= kAcross; ++a) see(line, static_cast<double>(a) / kAcross);
    if (surface.land() > 0.0) see(line, 1.0 - surface.land() / line.wall);
    if (out.depth > before) deepest_share = static_cast<double>(k) / kInGap;
  }
  if (!(out.depth > 0.0)) return out;
  const std::size_t solid = out.solid;
  const auto depth_at = [&](double at, double share) {
    const auto line = surface.line(row, at);
    const double depth = share * line.wall;
    return -solids[solid].distance(SectionSurface::place(line, depth, surface.z(line, depth)));
  };
  const auto most = [](const auto& of, double at, double step) {
    return math::golden_maximum<kGoldenSteps>(of, std::max(0.0, at - step),
                                              std::min(1.0, at + step))
        .at;
  };
  // Along, across, and along again, because a thin partner is deepest between the places looked at.
  for (int round = 0; round < kInGapRounds; ++round) {
    const double share = across;
    deepest_share =
        most([&](double at) { return depth_at(at, share); }, deepest_share, 1.0 / kInGap);
    see(surface.line(row, deepest_share), share);
    if (!(out.depth > kShallow)) break;
    const double way = deepest_share;
    across = most([&](double of) { return depth_at(way, of); }, across, 1.0 / kAcross);
    see(surface.line(row, way), across);
  }
  return out;
}

}  // namespace tubecut::bevel
