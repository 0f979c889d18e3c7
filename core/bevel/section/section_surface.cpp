#include "core/bevel/section/section_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/joint/solid.hpp"
#include "core/math/mixed.hpp"
#include "core/math/search.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr int kAlong = 24;      // places within reach of the beam
constexpr int kAcross = 4;      // parts of the wall
constexpr double kReach = 2.6;  // kerfs along s that a beam reaches where lines bunch
constexpr int kRounds = 3;      // of the search along and across
constexpr int kInGap = 8;       // parts of a gap between rows

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
    out.at = wall_.outer().at(table_.at[row].s + share * width(row));
    out.wall = wall_.across(out.at).wall;
  }
  out.inner = mixed(table_.z_inner);
  out.outer = mixed(table_.z_outer);
  out.face = table_.z_face.empty() ? out.inner : mixed(table_.z_face);
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

double SectionSurface::z(const Line& line, double depth) const {
  const double from_bore = line.wall - depth;  // outwards
  if (from_bore >= land())
    return math::mixed(line.face, line.outer, (from_bore - land()) / (line.wall - land()));
  return math::mixed(line.inner, line.face, from_bore / land());
}

double needed_drop(const SectionSurface& surface, std::size_t row, double share, double kerf) {
  const auto own = surface.line(row, share);
  const Eigen::Vector2d n = own.at.normal, t = own.at.tangent();
  const double slope = own.slope(surface.land()), secant = elementary::hypot(1.0, slope);
  const double half = 0.5 * kerf, girth = surface.wall().outer().girth();
  if (half == 0.0) return 0.0;
  const auto need = [&](double s, double part) {
    const double there = s - girth * std::floor(s / girth);
    const auto line = surface.line_at(surface.row_before(there), there);
    const double depth = part * line.wall;
    const Eigen::Vector2d off = line.at.point - depth * line.at.normal - own.at.point;
    const double u = off.dot(t), v = off.dot(n);
    if (!(std::abs(u) < half) || v < -(own.wall + kerf)) return -kUnbounded;
    return own.outer + v * slope - surface.z(line, depth) +
           std::sqrt((half - u) * (half + u)) * secant;
  };
  const double reach = kReach * kerf;
  double best = -kUnbounded, best_s = own.at.s, best_part = 0.0;
  const auto see = [&](double s, double part) {
    const double value = need(s, part);
    if (!(value > best)) return;
    best = value;
    best_s = s;
    best_part = part;
  };
  for (int k = -kAlong; k <= kAlong; ++k)
    for (int a = 0; a <= kAcross; ++a)
      see(own.at.s + reach * k / kAlong, static_cast<double>(a) / kAcross);
  for (int k = -kAlong; k <= kAlong; ++k)
    for (const double part : {0.0, 1.0}) see(own.at.s + half * k / kAlong, part);
  // The place at which most is needed, along the cut, across the wall, and along it again.
  for (int round = 0; round < kRounds; ++round) {
    const double part = best_part, s = best_s, step = reach / kAlong;
    const auto along =
        math::golden_maximum([&](double at) { return need(at, part); }, s - step, s + step);
    see(along.at, part);
    const double there = best_s, wide = 1.0 / kAcross;
    const auto across =
        math::golden_maximum([&](double at) { return need(there, at); }, std::max(0.0, part - wide),
                             std::min(1.0, part + wide));
    see(there, across.at);
  }
  return best;
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
  const double share = across;
  const std::size_t solid = out.solid;
  const auto depth_at = [&](double at) {
    const auto line = surface.line(row, at);
    const double depth = share * line.wall;
    return -solids[solid].distance(SectionSurface::place(line, depth, surface.z(line, depth)));
  };
  const auto most = math::golden_maximum(depth_at, std::max(0.0, deepest_share - 1.0 / kInGap),
                                         std::min(1.0, deepest_share + 1.0 / kInGap));
  see(surface.line(row, most.at), share);
  return out;
}

}  // namespace tubecut::bevel
