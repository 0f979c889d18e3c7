#include "api/formats/wall_spline.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "api/stop.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUneven = 6.0;  // a span to the one beside it

Vector3d on_wall(double radius, const Vector2d& p) {
  const auto [sin, cos] = elementary::sincos(p.x());
  return {radius * cos, radius * sin, p.y()};
}

/// A direction (per phi and z) on the wall in space.
Vector3d along_wall(double radius, double phi, const Vector2d& slope) {
  const auto [sin, cos] = elementary::sincos(phi);
  return {-radius * sin * slope.x(), radius * cos * slope.x(), slope.y()};
}

/// What makes a third of an arc's parameter the handle of the cubic nearest to it.
double handle(double dphi) {
  if (std::abs(dphi) < 1e-4) return 1.0 / 3.0;
  return 4.0 / 3.0 * elementary::tan(dphi / 4.0) / dphi;
}

template <typename Point>
Point value(const std::array<Point, 4>& c, double u) {
  const double v = 1.0 - u;
  return v * v * v * c[0] + 3.0 * u * v * v * c[1] + 3.0 * u * u * v * c[2] + u * u * u * c[3];
}
Vector3d slope(const std::array<Vector3d, 4>& c, double u) {
  const double v = 1.0 - u;
  return 3.0 * (v * v * (c[1] - c[0]) + 2.0 * u * v * (c[2] - c[1]) + u * u * (c[3] - c[2]));
}

/// Both halves of a cubic behind what there is of each.
template <typename Point>
void halve(const std::array<Point, 4>& c, std::vector<std::array<Point, 4>>& low,
           std::vector<std::array<Point, 4>>& high) {
  const Point a = 0.5 * (c[0] + c[1]), b = 0.5 * (c[1] + c[2]), d = 0.5 * (c[2] + c[3]);
  const Point ab = 0.5 * (a + b), bd = 0.5 * (b + d), middle = 0.5 * (ab + bd);
  low.push_back({c[0], a, ab, middle});
  high.push_back({middle, bd, d, c[3]});
}

/// The control points of a cubic behind the one it begins at; its end only where it counts as one.
template <typename Point>
void append(const std::array<Point, 4>& c, bool full, std::vector<Point>& out) {
  out.insert(out.end(), {c[1], c[2]});
  if (full) out.push_back(c[3]);
}

}  // namespace

struct WallCurve::Span {
  std::vector<Bezier> curves;
  std::vector<Flat> flats;
  double wide = 0.0;                   // of knots
  bool full = false, station = false;  // at its end
};

WallCurve::Bezier WallCurve::cubic(std::size_t edge, const Node& from, const Node& to) const {
  const double radius = edges_[edge].radius, wide = to.along - from.along;
  const Vector2d a = from.at[edge], b = to.at[edge];
  const double dphi = b.x() - a.x() + (to.turn - from.turn) * turn_;
  const double reach = handle(dphi) * wide;
  const Vector3d first = on_wall(radius, a), last = on_wall(radius, b);
  return {first, first + reach * along_wall(radius, a.x(), from.beyond[edge]),
          last - reach * along_wall(radius, b.x(), to.before[edge]), last};
}

/// With the handles of the cubic in space, so that both reach a place at the same parameter.
WallCurve::Flat WallCurve::flat_cubic(std::size_t edge, const Node& from, const Node& to) const {
  const Vector2d a = from.at[edge] + Vector2d(from.turn * turn_, 0.0);
  const Vector2d b = to.at[edge] + Vector2d(to.turn * turn_, 0.0);
  const double reach = handle(b.x() - a.x()) * (to.along - from.along);
  return {a, a + reach * from.beyond[edge], b - reach * to.before[edge], b};
}

bool WallCurve::near(const Bezier& curve, std::size_t edge, const Vector2d& point, double u) const {
  const Vector3d p = on_wall(edges_[edge].radius, point);
  Vector3d d = value(curve, u) - p;
  for (int round = 0; round < 3; ++round) {
    const Vector3d t = slope(curve, u);
    if (!(t.squaredNorm() > 0.0)) break;
    u = std::clamp(u - d.dot(t) / t.squaredNorm(), 0.0, 1.0);
    d = value(curve, u) - p;
  }
  return d.norm() <= off_rows_;
}

bool WallCurve::fits(const std::vector<Node>& nodes, std::size_t from, std::size_t to) const {
  const auto &a = nodes[from], &b = nodes[to];
  const double wide = b.along - a.along;
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    const double dphi = b.at[k].x() - a.at[k].x() + (b.turn - a.turn) * turn_;
    if (std::abs(dphi) > widest(edges_[k].radius)) return false;
    const auto curve = cubic(k, a, b);
    for (const double u : {0.25, 0.5, 0.75}) {
      const auto p = value(curve, u);
      const double off = p.head<2>().norm() - edges_[k].radius;
      if (std::abs(off) > off_cylinder_) return false;
      if (!off_flat_) continue;
      const auto twin = on_wall(edges_[k].radius, value(flat_cubic(k, a, b), u));
      if ((p - twin).norm() > *off_flat_) return false;
    }
    for (auto i = from + 1; i < to; ++i) {
      const Vector2d& at = nodes[i].at[k];
      if (!near(curve, k, at, (nodes[i].along - a.along) / wide)) return false;
    }
  }
  return true;
}

/// As far as one span can go: to a corner or a station at most.
std::size_t WallCurve::farthest(const std::vector<Node>& nodes, std::size_t from) const {
  std::size_t most = from + 1;
  while (most + 1 < nodes.size() && !nodes[most].corner && !nodes[most].station) ++most;
  std::size_t good = from + 1, bad = most + 1;
  for (std::size_t reach = 2; from + reach <= most; reach *= 2) {
    if (!fits(nodes, from, from + reach)) {
      bad = from + reach;
      break;
    }
    good = from + reach;
  }
  while (bad - good > 1) {
    const auto middle = good + (bad - good) / 2;
    (fits(nodes, from, middle) ? good : bad) = middle;
  }
  return good;
}

std::vector<WallCurve::Span> WallCurve::spans(const std::vector<Node>& nodes,
                                              const std::stop_token& stop) const {
  std::vector<Span> out;
  for (std::size_t from = 0; from + 1 < nodes.size();) {
    ask(stop);
    const auto to = farthest(nodes, from);
    const auto &a = nodes[from], &b = nodes[to];
    Span one{.curves = {},
             .flats = {},
             .wide = 0.0,
             .full = b.corner || b.station,
             .station = b.station};
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      one.curves.push_back(cubic(k, a, b));
      one.flats.push_back(flat_cubic(k, a, b));
      const double dphi = b.at[k].x() - a.at[k].x() + (b.turn - a.turn) * turn_;
      one.wide = std::max(one.wide, 3.0 * handle(dphi) * (b.along - a.along));
    }
    out.push_back(std::move(one));
    from = to;
  }
  return out;
}

/// The same curve, no span much wider than those beside it: readers put curves through points of
/// each span, and such curves swing where a short one stands by a long one.
std::vector<WallCurve::Span> WallCurve::graded(std::vector<Span> spans,
                                               const std::stop_token& stop) {
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<Span> out;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      ask(stop);
      const double before = spans[(i + spans.size() - 1) % spans.size()].wide;
      const double behind = spans[(i + 1) % spans.size()].wide;
      if (spans[i].wide <= kUneven * std::min(before, behind)) {
        out.push_back(std::move(spans[i]));
        out.back().wide = spans[i].wide;
        continue;
      }
      changed = true;
      Span first{.curves = {}, .flats = {}, .wide = 0.5 * spans[i].wide};
      Span second{.curves = {}, .flats = {}, .wide = 0.5 * spans[i].wide};
      second.full = spans[i].full;
      second.station = spans[i].station;
      for (const auto& curve : spans[i].curves) halve(curve, first.curves, second.curves);
      for (const auto& flat : spans[i].flats) halve(flat, first.flats, second.flats);
      out.push_back(std::move(first));
      out.push_back(std::move(second));
    }
    spans = std::move(out);
  }
  return spans;
}

WallSpline WallCurve::spline(const std::vector<Place>& stations,
                             const std::stop_token& stop) const {
  const auto all = graded(spans(nodes(stations), stop), stop);
  WallSpline out{.joints = {{}}, .points = {}, .flat = {}, .stations = {0}};
  for (const auto& first : all.front().curves) out.points.push_back({first[0]});
  for (const auto& first : all.front().flats) out.flat.push_back({first[0]});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& one = all[i];
    const bool last = i + 1 == all.size();
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      append(one.curves[k], one.full || last, out.points[k]);
      append(one.flats[k], one.full || last, out.flat[k]);
    }
    out.joints.push_back({.u = out.joints.back().u + one.wide,
                          .full = one.full || last,
                          .control = out.points.front().size() - 1});
    if (one.station && !last) out.stations.push_back(out.joints.size() - 1);
  }
  for (auto& edge : out.points) edge.back() = edge.front();
  return out;
}

}  // namespace tubecut::api
