#include "api/formats/step/wall_spline.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "api/formats/step/wall_curve.hpp"
#include "api/stop.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUneven = 6.0;  // ratio of a span to an adjacent one
// mm, of a span between two adjacent nodes from its cylinder. If phi's rate changes much there, as
// next to a corner, the cubic in space leaves the cylinder, although the one in (phi, z) does not.
constexpr double kOffAlone = 1e-4;
constexpr int kHalvings = 8;  // each takes a sixteenth of that distance

/// Returns the factor from a third of an arc's parameter to the handle of the nearest cubic.
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

/// Appends both halves of a cubic to each.
template <typename Point>
void halve(const std::array<Point, 4>& c, std::vector<std::array<Point, 4>>& low,
           std::vector<std::array<Point, 4>>& high) {
  const Point a = 0.5 * (c[0] + c[1]), b = 0.5 * (c[1] + c[2]), d = 0.5 * (c[2] + c[3]);
  const Point ab = 0.5 * (a + b), bd = 0.5 * (b + d), middle = 0.5 * (ab + bd);
  low.push_back({c[0], a, ab, middle});
  high.push_back({middle, bd, d, c[3]});
}

/// Appends the control points of a cubic after its start; its end only if it counts as one.
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

Vector3d WallCurve::Edge::in_space(const Vector2d& flat) const {
  const auto [sin, cos] = elementary::sincos(flat.x());
  const double r = plane ? plane->distance / elementary::cos(flat.x() - plane->phi) : radius;
  return {r * cos, r * sin, flat.y()};
}

double WallCurve::Edge::off(const Vector3d& place) const {
  if (!plane) return place.head<2>().norm() - radius;
  const auto [sin, cos] = elementary::sincos(plane->phi);
  return cos * place.x() + sin * place.y() - plane->distance;
}

double WallCurve::turned(std::size_t edge, const Node& from, const Node& to) const {
  return to.edges[edge].flat.at.x() - from.edges[edge].flat.at.x() + (to.turn - from.turn) * turn_;
}

WallCurve::Pair WallCurve::cubics(std::size_t edge, const Node& from, const Node& to) const {
  const auto &a = from.edges[edge], &b = to.edges[edge];
  const double reach = handle(turned(edge, from, to)) * (to.along - from.along);
  const auto cubic = [&](const auto& first, const auto& last) {
    return Cubic<std::decay_t<decltype(first.at)>>{first.at, first.at + reach * first.beyond,
                                                   last.at - reach * last.before, last.at};
  };
  Pair out{.space = cubic(a.space, b.space), .flat = cubic(a.flat, b.flat)};
  for (auto i : {0U, 1U}) out.flat[i].x() += from.turn * turn_;
  for (auto i : {2U, 3U}) out.flat[i].x() += to.turn * turn_;
  return out;
}

bool WallCurve::near(const Bezier& curve, const Vector3d& point, double u) const {
  Vector3d d = value(curve, u) - point;
  for (int round = 0; round < 3 && d.squaredNorm() > off_rows_ * off_rows_; ++round) {
    const Vector3d t = slope(curve, u);
    if (!(t.squaredNorm() > 0.0)) break;
    u = std::clamp(u - d.dot(t) / t.squaredNorm(), 0.0, 1.0);
    d = value(curve, u) - point;
  }
  return d.norm() <= off_rows_;
}

bool WallCurve::fits(const std::vector<Node>& nodes, std::size_t from, std::size_t to) const {
  const auto &a = nodes[from], &b = nodes[to];
  const double wide = b.along - a.along;
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    if (std::abs(turned(k, a, b)) > edges_[k].widest) return false;
    const auto both = cubics(k, a, b);
    for (const double u : {0.25, 0.5, 0.75}) {
      const auto p = value(both.space, u);
      if (std::abs(edges_[k].off(p)) > off_cylinder_) return false;
      if (!off_flat_) continue;
      const auto twin = edges_[k].in_space(value(both.flat, u));
      if ((p - twin).norm() > *off_flat_) return false;
    }
    Pace pace;
    for (auto i = from + 1; i < to; ++i) {
      pace.tick();
      const auto& at = nodes[i].edges[k].space.at;
      if (!near(both.space, at, (nodes[i].along - a.along) / wide)) return false;
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

bool WallCurve::on_cylinders(const Node& from, const Node& to) const {
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    const auto both = cubics(k, from, to);
    for (const double u : {0.25, 0.5, 0.75}) {
      if (std::abs(edges_[k].off(value(both.space, u))) > kOffAlone) return false;
    }
  }
  return true;
}

void WallCurve::add_spans(const Node& from, const Node& to, double origin, int halvings,
                          std::vector<Span>& out) const {
  if (halvings > 0 && !on_cylinders(from, to)) {
    const auto middle = node_at(0.5 * (from.along + to.along), origin);
    add_spans(from, middle, origin, halvings - 1, out);
    add_spans(middle, to, origin, halvings - 1, out);
    return;
  }
  Span one{.curves = {},
           .flats = {},
           .wide = 0.0,
           .full = to.corner || to.station,
           .station = to.station};
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    const auto both = cubics(k, from, to);
    one.curves.push_back(both.space);
    one.flats.push_back(both.flat);
    one.wide = std::max(one.wide, 3.0 * handle(turned(k, from, to)) * (to.along - from.along));
  }
  out.push_back(std::move(one));
}

std::vector<WallCurve::Span> WallCurve::spans(const std::vector<Node>& nodes) const {
  std::vector<Span> out;
  const double origin = along(nodes.front().position);
  for (std::size_t from = 0; from + 1 < nodes.size();) {
    ask();
    const auto to = farthest(nodes, from);
    add_spans(nodes[from], nodes[to], origin, to == from + 1 ? kHalvings : 0, out);
    from = to;
  }
  return out;
}

/// Returns the same curve with no span much wider than the adjacent ones, because readers put
/// curves through points of each span, and such curves swing if a short span follows a long one.
std::vector<WallCurve::Span> WallCurve::graded(std::vector<Span> spans) {
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<Span> out;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      ask();
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

WallSpline WallCurve::spline(const std::vector<RowPosition>& stations) const {
  const auto all = graded(spans(nodes(stations)));
  WallSpline out{.knots = {{}}, .points = {}, .flat = {}, .stations = {0}};
  for (const auto& first : all.front().curves) out.points.push_back({first[0]});
  for (const auto& first : all.front().flats) out.flat.push_back({first[0]});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& one = all[i];
    const bool last = i + 1 == all.size();
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      append(one.curves[k], one.full || last, out.points[k]);
      append(one.flats[k], one.full || last, out.flat[k]);
    }
    out.knots.push_back({.u = out.knots.back().u + one.wide,
                         .full = one.full || last,
                         .control = out.points.front().size() - 1});
    if (one.station && !last) out.stations.push_back(out.knots.size() - 1);
  }
  for (auto& edge : out.points) edge.back() = edge.front();
  return out;
}

}  // namespace tubecut::api
