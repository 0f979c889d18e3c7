#include "core/bevel/beam_axes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::bevel::beam {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2.0 * kRadPerDeg;  // over which a helix is a parabola: 1e-6 of the radius
constexpr double kSwing =
    3.0 * kRadPerDeg;                // over which the squared distance is all but a parabola
constexpr double kArc = 1.01;        // no longer than that is an arc over its chord
constexpr double kMostParts = 64.0;  // of the way from row to row, each no longer than four kerfs
constexpr double kTiny = 1e-300;
constexpr int kParabolas = 4;
constexpr double kStill = 1e-4;  // of a stretch

}  // namespace

Line placed(const BeamCut& cut, const AcrossWall& at) {
  const auto inner = elementary::sincos(at.phi_inner);
  const bool axial = at.phi_outer == at.phi_inner;  // as every end's are
  const auto outer = axial ? inner : elementary::sincos(at.phi_outer);
  return {{cut.inner * inner.cos, cut.inner * inner.sin, at.z_inner},
          {cut.outer * outer.cos, cut.outer * outer.sin, at.z_outer}};
}

AcrossWall between(const std::vector<AcrossWall>& rows, double turn, std::size_t i, double u) {
  auto b = rows[(i + 1) % rows.size()];
  if (i + 1 == rows.size()) {
    b.phi_inner += turn;
    b.phi_outer += turn;
  }
  const auto& a = rows[i];
  return {mixed(a.phi_inner, b.phi_inner, u), mixed(a.z_inner, b.z_inner, u),
          mixed(a.phi_outer, b.phi_outer, u), mixed(a.z_outer, b.z_outer, u)};
}

Axes::Axes(const BeamCut& cut, const std::stop_token& stop) : cut_(cut) {
  const auto n = cut.torch.size();
  stretches_.reserve(2 * n);
  first_.reserve(n + 1);
  if (n == 0) return;
  Line here = placed(cut, torch(0, 0.0));
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
    first_.push_back(stretches_.size());
    const auto a = torch(i, 0.0), b = torch(i, 1.0);
    const double wide =
        std::max(std::abs(b.phi_inner - a.phi_inner), std::abs(b.phi_outer - a.phi_outer));
    const double rise = std::max(std::abs(b.z_inner - a.z_inner), std::abs(b.z_outer - a.z_outer));
    const double way = std::min(rise + cut.outer * wide, 4.0 * kMostParts * cut.kerf);
    const Line next = placed(cut, b);
    const Vector3d from = here.to - here.from, to = next.to - next.from;
    const double swing = elementary::atan2(from.cross(to).norm(), from.dot(to));
    const int parts =
        1 +
        static_cast<int>(std::max({wide / kTurn, way / (4.0 * cut.kerf + kTiny), swing / kSwing}));
    for (int k = 0; k < parts; ++k) {
      const double begin = static_cast<double>(k) / parts, end = static_cast<double>(k + 1) / parts;
      const Line last = k + 1 < parts ? placed(cut, torch(i, end)) : next;
      add(i, begin, end, here, last);
      here = last;
    }
  }
  first_.push_back(stretches_.size());
  travelled_.push_back(0.0);
  for (std::size_t k = 0; k < 2 * stretches_.size(); ++k)
    travelled_.push_back(travelled_.back() + stretches_[k % stretches_.size()].travel);
  meridian_ = cut.inner > 0.0 && cut.turn > 0.0;
  for (std::size_t i = 0; i < n && meridian_; ++i) {
    const auto a = torch(i, 0.0), b = torch(i, 1.0);
    meridian_ =
        a.phi_inner == a.phi_outer && b.phi_inner == b.phi_outer && a.phi_inner <= b.phi_inner;
  }
}

Nearest Axes::nearest(std::size_t row, double u, const Vector3d& q) const {
  const auto n = stretches_.size();
  std::size_t start = first_[row];
  while (start + 1 < first_[row + 1] && stretches_[start + 1].from <= u) ++start;
  const auto& own = stretches_[start];
  Best best{start, std::clamp((u - own.from) / (own.to - own.from), 0.0, 1.0)};
  best.square = own.square(best.x, q);
  best.distance = std::sqrt(best.square);
  // Half a lap of stretches is no half turn: where the turn decides they may run all round.
  const auto lap = meridian_ ? n - 1 : n / 2;
  walk(start, start + lap, q, best);
  walk_back(start + n, start + n - lap, q, best);
  const auto& s = stretches_[best.stretch];
  return {best.square, s.at(best.x, q), s.row, mixed(s.from, s.to, best.x)};
}

AcrossWall Axes::torch(std::size_t row, double u) const {
  return between(cut_.torch, cut_.turn, row, u);
}

void Axes::add(std::size_t row, double from, double to, const Line& first, const Line& last) {
  Stretch out{.row = row, .from = from, .to = to};
  const Line middle = placed(cut_, torch(row, mixed(from, to, 0.5)));
  const std::array<Vector3d, 3> in{first.from, middle.from, last.from};
  const std::array<Vector3d, 3> over{first.to - first.from, middle.to - middle.from,
                                     last.to - last.from};
  out.inner = {in[0], 4.0 * in[1] - 3.0 * in[0] - in[2], 2.0 * (in[0] - 2.0 * in[1] + in[2])};
  out.across = {over[0], 4.0 * over[1] - 3.0 * over[0] - over[2],
                2.0 * (over[0] - 2.0 * over[1] + over[2])};
  for (std::size_t end = 0; end < 2; ++end)
    out.ends[end] = {in[2 * end], over[2 * end], 1.0 / over[2 * end].squaredNorm()};
  out.middle = -cut_.inner / (cut_.outer - cut_.inner);
  const double inner = (in[2] - in[0]).norm(), outer = (in[2] + over[2] - in[0] - over[0]).norm();
  const double beyond = cut_.kerf / over[0].norm() * (over[2] - over[0]).norm();
  out.travel = kArc * (std::max(inner, outer) + beyond);
  stretches_.push_back(out);
}

void Axes::Best::see(std::size_t k, double at, double value) {
  if (value >= square) return;
  *this = {k, at, value, std::sqrt(value)};
}

/// How far q is from the half plane through the tube's axis in which an axis stands, up to a
/// quarter turn ahead of q, negative behind it; no axis further ahead is nearer than that, up to
/// half a turn.
double Axes::ahead(const Stretch::End& end, const Vector3d& q) const {
  return (q.x() * end.inner.y() - q.y() * end.inner.x()) / cut_.inner;
}

/// Stretches ahead. Where the axes are further away than the best one, none nearer comes before
/// they have travelled as much.
void Axes::walk(std::size_t k, std::size_t last, const Vector3d& q, Best& best) const {
  double low = stretch(k).square_first(q);
  while (k <= last) {
    const double high = stretch(k).square_last(q), far = std::sqrt(high);
    look(k, low, high, std::sqrt(low) + far, q, best);
    if (meridian_ && ahead(stretch(k).ends[1], q) >= best.distance) return;
    const double clear = travelled_[k + 1] + std::max(0.0, far - best.distance);
    if (travelled_[k + 2] > clear) {
      ++k;
      low = high;
      continue;
    }
    const auto past = std::ranges::upper_bound(travelled_, clear) - travelled_.begin();
    k = static_cast<std::size_t>(past) - 1;
    low = stretch(k).square_first(q);
  }
}

/// Stretches behind `end`, likewise.
void Axes::walk_back(std::size_t end, std::size_t first, const Vector3d& q, Best& best) const {
  double high = stretch(end).square_first(q);
  while (end > first) {
    const auto k = end - 1;
    const double low = stretch(k).square_first(q), far = std::sqrt(low);
    look(k, low, high, far + std::sqrt(high), q, best);
    if (meridian_ && -ahead(stretch(k).ends[0], q) >= best.distance) return;
    const double clear = travelled_[k] - std::max(0.0, far - best.distance);
    if (k == 0 || travelled_[k - 1] < clear) {
      end = k;
      high = low;
      continue;
    }
    const auto from = std::ranges::lower_bound(travelled_, clear) - travelled_.begin();
    end = static_cast<std::size_t>(from);
    high = stretch(end).square_first(q);
  }
}

/// Along one stretch, if a nearer axis could be in it: the squared distance is all but a parabola.
/// `both` is the sum of the distances at its ends.
void Axes::look(std::size_t index, double low, double high, double both, const Vector3d& q,
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
void Axes::descend(std::size_t k, double x, const Vector3d& q, Best& best) const {
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

}  // namespace tubecut::bevel::beam
