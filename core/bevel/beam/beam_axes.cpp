#include "core/bevel/beam/beam_axes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"

namespace tubecut::bevel::beam {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2.0 * kRadPerDeg;   // over which a helix is a parabola: 1e-6 of the radius
constexpr double kSwing = 3.0 * kRadPerDeg;  // over which the squared distance is nearly a parabola
constexpr double kArc = 1.01;                // maximum ratio of an arc to its chord
constexpr double kMostParts = 64.0;  // of the path from row to row, each at most four kerfs long
constexpr double kTiny = 1e-300;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool axial(const AcrossWall& at) { return at.phi_outer == at.phi_inner; }  // true for every end

double apart(double a, double b) { return std::abs(b - a); }

AxisAt axis_at(const Vector3d& p, const Vector3d& d) {
  return {{p.x(), p.y(), p.z()}, {d.x(), d.y(), d.z()}, 1.0 / d.squaredNorm()};
}

std::array<double, 3> numbers(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Returns the parabola through three points, by powers of the fraction of the path.
std::array<std::array<double, 3>, 3> parabola(const Vector3d& a, const Vector3d& b,
                                              const Vector3d& c) {
  return {numbers(a), numbers(4.0 * b - 3.0 * a - c), numbers(2.0 * (a - 2.0 * b + c))};
}

Vector3d at_share(const std::array<std::array<double, 3>, 3>& by, double x) {
  const auto value = [&](std::size_t k) { return by[0][k] + x * (by[1][k] + x * by[2][k]); };
  return {value(0), value(1), value(2)};
}

}  // namespace

Line placed(const BeamCut& cut, const AcrossWall& at) {
  const auto inner = elementary::sincos(at.phi_inner);
  const auto outer = axial(at) ? inner : elementary::sincos(at.phi_outer);
  return {{cut.inner * inner.cos, cut.inner * inner.sin, at.z_inner},
          {cut.outer * outer.cos, cut.outer * outer.sin, at.z_outer}};
}

void placed(const BeamCut& cut, std::span<const AcrossWall> at, std::span<Line> out) {
  Eight phases, sine, cosine;
  for (std::size_t first = 0; first < at.size(); first += kLanes) {
    const auto some = at.subspan(first, std::min(kLanes, at.size() - first));
    const auto n = some.size();
    const auto of = [&](double AcrossWall::*phase) {
      std::ranges::transform(some, phases.begin(), phase);
      elementary::sincos(std::span(phases).first(n), std::span(sine).first(n),
                         std::span(cosine).first(n));
    };
    of(&AcrossWall::phi_inner);
    for (std::size_t k = 0; k < n; ++k)
      out[first + k].from = {cut.inner * cosine[k], cut.inner * sine[k], some[k].z_inner};
    if (!std::ranges::all_of(some, axial)) of(&AcrossWall::phi_outer);
    for (std::size_t k = 0; k < n; ++k)
      out[first + k].to = {cut.outer * cosine[k], cut.outer * sine[k], some[k].z_outer};
  }
}

std::vector<Line> placed(const BeamCut& cut, std::span<const AcrossWall> at) {
  std::vector<Line> out(at.size());
  placed(cut, at, out);
  return out;
}

AcrossWall between(const std::vector<AcrossWall>& rows, double turn, std::size_t i, double u) {
  auto b = rows[i + 1 < rows.size() ? i + 1 : 0];
  if (i + 1 == rows.size()) {
    b.phi_inner += turn;
    b.phi_outer += turn;
  }
  const auto& a = rows[i];
  return {mixed(a.phi_inner, b.phi_inner, u), mixed(a.z_inner, b.z_inner, u),
          mixed(a.phi_outer, b.phi_outer, u), mixed(a.z_outer, b.z_outer, u)};
}

Axes::Axes(const BeamCut& cut) : cut_(cut) {
  const auto n = cut.torch.size();
  if (n == 0) return;
  auto rows = placed(cut, cut.torch);
  rows.push_back(placed(cut, between(cut.torch, cut.turn, n - 1, 1.0)));
  divide(rows);
  add_ways(rows);
  travelled_.push_back(0.0);
  for (std::size_t k = 0; k < 2 * ways_.size(); ++k)
    travelled_.push_back(travelled_.back() + way(k).travel);
  meridian_ = cut.inner > 0.0 && cut.turn > 0.0;
  for (std::size_t i = 0; i < n && meridian_; ++i) {
    const auto &a = cut.torch[i], &b = cut.torch[i + 1 < n ? i + 1 : 0];
    meridian_ = axial(a) && a.phi_inner <= b.phi_inner + (i + 1 < n ? 0.0 : cut.turn);
  }
}

/// Divides the path into segments.
void Axes::divide(const std::vector<Line>& rows) {
  const auto n = cut_.torch.size();
  for (std::size_t i = 0; i < n; ++i) {
    first_.push_back(parts_.size());
    const auto &a = cut_.torch[i], b = between(cut_.torch, cut_.turn, i, 1.0);
    const double wide = std::max(apart(a.phi_inner, b.phi_inner), apart(a.phi_outer, b.phi_outer));
    const double rise = std::max(apart(a.z_inner, b.z_inner), apart(a.z_outer, b.z_outer));
    const double way = std::min(rise + cut_.outer * wide, 4.0 * kMostParts * cut_.kerf);
    const Vector3d from = rows[i].to - rows[i].from, to = rows[i + 1].to - rows[i + 1].from;
    const double cross = from.cross(to).norm(), dot = from.dot(to);
    // Angles below half of kSwing make no further part.
    const double swing = cross < 0.5 * kSwing * dot ? 0.0 : elementary::atan2(cross, dot);
    const int parts =
        1 +
        static_cast<int>(std::max({wide / kTurn, way / (4.0 * cut_.kerf + kTiny), swing / kSwing}));
    for (int k = 0; k < parts; ++k)
      parts_.push_back({i, static_cast<double>(k) / parts, static_cast<double>(k + 1) / parts});
  }
  first_.push_back(parts_.size());
}

void Axes::add_ways(const std::vector<Line>& rows) {
  constexpr std::size_t kTogether = 256;
  std::vector<AcrossWall> at;
  ways_.reserve(parts_.size());
  Line here = rows.front();
  for (std::size_t k = 0; k < parts_.size(); k += kTogether) {
    if (stopped()) break;
    const auto end = std::min(parts_.size(), k + kTogether);
    at.clear();
    for (auto j = k; j < end; ++j) {
      const auto& [row, from, to] = parts_[j];
      at.push_back(between(cut_.torch, cut_.turn, row, mixed(from, to, 0.5)));
      if (to < 1.0) at.push_back(between(cut_.torch, cut_.turn, row, to));
    }
    const auto lines = placed(cut_, at);
    auto line = lines.begin();
    for (auto j = k; j < end; ++j) {
      const Line& middle = *line++;
      const Line last = parts_[j].to < 1.0 ? *line++ : rows[parts_[j].row + 1];
      ways_.push_back(way(here, middle, last));
      here = last;
    }
  }
  if (ways_.size() < parts_.size()) ways_.resize(parts_.size(), Way{});  // when cancelled: not read
}

Way Axes::way(const Line& first, const Line& middle, const Line& last) const {
  const std::array<Vector3d, 3> over{first.to - first.from, middle.to - middle.from,
                                     last.to - last.from};
  const double inner = (last.from - first.from).norm(), outer = (last.to - first.to).norm();
  const double beyond = cut_.kerf / over[0].norm() * (over[2] - over[0]).norm();
  return {.first = axis_at(first.from, over[0]),
          .middle = axis_at(middle.from, over[1]),
          .last = axis_at(last.from, over[2]),
          .inner = parabola(first.from, middle.from, last.from),
          .across = parabola(over[0], over[1], over[2]),
          .floor = -cut_.inner / (cut_.outer - cut_.inner),
          .travel = kArc * (std::max(inner, outer) + beyond)};
}

std::size_t Axes::stretch_of(const OnWay& at) const {
  auto k = first_[at.row];
  while (k + 1 < first_[at.row + 1] && parts_[k + 1].from <= at.u) ++k;
  return k;
}

/// Returns the segments that contain the points, from the first to the last. On a ring, the last
/// may be in the second lap.
std::pair<std::size_t, std::size_t> Axes::stretches(std::span<const OnWay> own) const {
  const auto lap = static_cast<std::ptrdiff_t>(ways_.size());
  const auto start = static_cast<std::ptrdiff_t>(stretch_of(own.front()));
  std::ptrdiff_t before = 0, after = 0;
  for (const auto& at : own) {
    auto off = static_cast<std::ptrdiff_t>(stretch_of(at)) - start;
    if (2 * off > lap) off -= lap;
    if (2 * off < -lap) off += lap;
    before = std::min(before, off);
    after = std::max(after, off);
  }
  const auto low = static_cast<std::size_t>(start + before + (start + before < 0 ? lap : 0));
  return {low, low + static_cast<std::size_t>(after - before)};
}

void Axes::see_first(std::size_t k, const EightPoints& points, Eight& square,
                     EightNearest& best) const {
  squares(way(k).first, way(k).floor, points, square);
  see(static_cast<double>(k % ways_.size()), 0.0, square, best);
}

/// If the axes are further away than the best ones, no nearer one comes before they have travelled
/// the difference. For a cut around the tube, no nearer one comes once their half planes, up to
/// half a revolution ahead of the points, are further away.
Walked Axes::walk_on(std::size_t k, bool on, const EightPoints& points, Eight& square,
                     EightNearest& best) const {
  const double inner = cut_.inner > 0.0 ? cut_.inner : 1.0;
  return walk(way(k), static_cast<double>(k % ways_.size()), on, inner, points, square, best);
}

void Axes::walk_ahead(std::size_t k, std::size_t last, const EightPoints& points, Eight square,
                      EightNearest& best) const {
  const auto n = ways_.size();
  while (k <= last) {
    const auto walked = walk_on(k, true, points, square, best);
    if (meridian_ && walked.beside >= 0.0) return;
    const auto base = k - k % n;  // the travelled distance covers two laps
    const double clear = travelled_[k - base + 1] + walked.clear;
    if (travelled_[k - base + 2] > clear) {
      ++k;
      continue;
    }
    const auto past = std::ranges::upper_bound(travelled_, clear) - travelled_.begin();
    k = static_cast<std::size_t>(past) - 1 + base;
    see_first(k, points, square, best);
  }
}

void Axes::walk_back(std::size_t end, std::size_t first, const EightPoints& points, Eight square,
                     EightNearest& best) const {
  for (auto k = end; k > first;) {
    --k;
    const auto walked = walk_on(k, false, points, square, best);
    if (meridian_ && walked.beside >= 0.0) return;
    const double clear = travelled_[k] - walked.clear;
    if (k == 0 || travelled_[k - 1] < clear) continue;
    const auto from = std::ranges::lower_bound(travelled_, clear) - travelled_.begin();
    k = static_cast<std::size_t>(from);
    see_first(k, points, square, best);
  }
}

/// Starts at the points' own axes, and walks ahead and back.
void Axes::nearest(std::span<const OnWay> own, const EightPoints& points,
                   std::span<Nearest> out) const {
  const auto n = ways_.size();
  const auto [low, high] = stretches(own);
  EightNearest best;
  best.square.fill(kInfinity);
  best.distance.fill(kInfinity);
  best.stretch.fill(0.0);
  best.share.fill(0.0);
  Eight first, square;
  see_first(low, points, first, best);
  for (auto k = low; k <= high; ++k) {
    squares(way(k).last, way(k).floor, points, square);
    see(static_cast<double>(k % n), 1.0, square, best);
  }
  // Half a lap of segments is not half a revolution; if the revolution decides, they may run all
  // around.
  const auto run = meridian_ ? n - 1 : n / 2;
  walk_ahead(low, high + run, points, first, best);
  walk_back(low + n, low + n - run, points, first, best);
  for (std::size_t l = 0; l < out.size(); ++l) {
    const auto k = static_cast<std::size_t>(best.stretch[l]);
    const auto& [row, from, to] = parts_[k];
    out[l] = {best.square[l], {row, mixed(from, to, best.share[l])}, k, best.share[l]};
  }
}

Eigen::Vector3d Axes::point(const Nearest& axis, const Vector3d& q) const {
  const auto& w = ways_[axis.stretch];
  const Vector3d p = at_share(w.inner, axis.share), d = at_share(w.across, axis.share);
  return p + std::max((q - p).dot(d) / d.squaredNorm(), w.floor) * d;
}

}  // namespace tubecut::bevel::beam
