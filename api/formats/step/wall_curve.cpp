#include "api/formats/step/wall_curve.hpp"

#include <algorithm>
#include <cmath>

#include "api/stop.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A volume goes by the mean of these two over the wall and over the length.
constexpr double kOffCylinder = 1e-6;  // of the wall: how far an edge may leave its cylinder
constexpr double kOffRows = 2e-4;      // mm: how far a curve may leave the rows as laid,
constexpr double kOffRadius = 6e-6;    // and of the radius
// If the curve passes through the rows, it need not keep that volume; with the rounding of its
// numbers it stays within 1e-3 mm of them.
constexpr double kOffRowsThrough = 7e-4;
constexpr double kOffRadiusThrough = 2e-5;
constexpr double kRoundedSag = kSplineError / 0.75;  // mm, of rows that one curve may pass,
constexpr double kRoundedRadius = 5e-5;              // and of the radius
constexpr std::size_t kShortestRun = 8;              // of such rows
constexpr double kSharp = 0.3;   // rad: a bend above it is a corner, however short its sides
constexpr double kKink = 4.0;    // a turn to those on either side of it
constexpr double kWidest = 0.5;  // rad, of a span
// mm, of a cubic in space to that in (phi, z) at one parameter. If a reader finds a larger distance
// between them than the file's uncertainty, it fits its own curve, which swings at the corners.
constexpr double kOffFlat = 6e-5;
constexpr std::size_t kForgotten = 54;  // 2^-54 is below the last bit
constexpr double kKnotDistance = 3e-4;  // mm along the rows: nearer places are one

}  // namespace

WallCurve::WallCurve(const bevel::CutWall& wall, const EdgePlanes& planes) : turn_(wall.turn) {
  for (const auto& edge : wall.edges) {
    const auto k = edges_.size();
    edges_.push_back({.radius = edge.radius,
                      .plane = k < planes.size() ? planes[k] : std::nullopt,
                      .row = {},
                      .gap = {},
                      .knot = {},
                      .arriving = {},
                      .leaving = {}});
  }
  for (std::size_t i = 0; i < wall.gaps(); ++i) {
    double moved = i == 0 ? 1.0 : 0.0;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      const Vector2d p(wall.edges[k].phi[i], wall.edges[k].z[i]);
      if (i > 0) moved = std::max(moved, (p - edges_[k].row.back()).norm());
    }
    if (moved == 0.0) continue;  // one row twice
    for (std::size_t k = 0; k < edges_.size(); ++k)
      edges_[k].row.emplace_back(wall.edges[k].phi[i], wall.edges[k].z[i]);
  }
  const auto n = edges_.front().row.size();
  for (auto& edge : edges_) {
    for (std::size_t i = 1; i < n; ++i) edge.gap.emplace_back(edge.row[i] - edge.row[i - 1]);
    edge.gap.emplace_back(edge.row.front() - edge.row.back() + Vector2d(turn_, 0.0));
  }
  for (std::size_t i = 0; i < n; ++i) {
    double longest = 0.0;
    for (const auto& edge : edges_) {
      const Vector2d& d = edge.gap[i];
      const double round = std::abs(edge.radius * d.x());
      // Round a tube the parameter is phi: then every edge is at one phi for one parameter.
      longest =
          std::max(longest, turn_ > 0.0 && round > 0.0 ? round : elementary::hypot(round, d.y()));
    }
    along_.push_back(around_);
    length_.push_back(longest);
    around_ += longest;
  }
  corner_.assign(n, false);
  const double thick = edges_.back().radius - edges_.front().radius;
  off_cylinder_ = kOffCylinder * thick;
  off_rows_ = std::min(kOffRows, kOffRadius * edges_.back().radius);
  for (auto& edge : edges_)  // an arc's cubic is off by 3.6e-5 r angle^6
    edge.widest =
        std::min(kWidest, elementary::pow(off_cylinder_ / (3.7e-5 * edge.radius), 1.0 / 6.0));
}

Vector2d WallCurve::laid_gap(const Edge& edge, std::size_t row) const {
  const auto next = (row + 1) % edge.knot.size();
  return edge.knot[next] - edge.knot[row] + Vector2d(next == 0 ? turn_ : 0.0, 0.0);
}

WallCurve WallCurve::straight(const bevel::CutWall& wall, const EdgePlanes& planes) {
  WallCurve out(wall, planes);
  out.off_flat_ = kOffFlat;
  out.find_lines();
  out.lay(true);
  return out;
}

WallCurve WallCurve::smooth(const bevel::CutWall& wall, const std::vector<bool>& corners,
                            const EdgePlanes& planes) {
  WallCurve out(wall, planes);
  out.off_rows_ = std::min(kOffRowsThrough, kOffRadiusThrough * out.edges_.back().radius);
  if (corners.size() == out.rows()) out.corner_ = corners;
  out.find_kinks();
  out.lay(false);
  return out;
}

/// Turn of an edge at each of its rows: rad, per mm of the adjacent lines, and the distance of a
/// curve with that turn from them.
struct WallCurve::Bend {
  double angle = 0.0, rate = 0.0, off = 0.0;
  bool still = false;  // a row that is the one before it, on this edge
};

std::vector<WallCurve::Bend> WallCurve::bends(const Edge& edge) const {
  const auto n = rows();
  std::vector<Bend> out(n);
  std::vector<double> cross(n), dot(n), length(n), angle(n);
  const Vector2d scale(edge.radius, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d a = scale.cwiseProduct(edge.gap[i == 0 ? n - 1 : i - 1]);
    const Vector2d b = scale.cwiseProduct(edge.gap[i]);
    cross[i] = a.x() * b.y() - a.y() * b.x();
    dot[i] = a.dot(b);
    length[i] = b.norm();
  }
  elementary::atan2(cross, dot, angle);
  for (std::size_t i = 0; i < n; ++i) {
    const double before = length[i == 0 ? n - 1 : i - 1], lines = before + length[i];
    out[i].angle = std::abs(angle[i]);
    out[i].rate = lines > 0.0 ? out[i].angle / lines : 0.0;
    out[i].off = out[i].angle * std::max(before, length[i]) / 8.0;
    out[i].still = before == 0.0 || length[i] == 0.0;
  }
  return out;
}

/// Finds the lines. A row is not a line if a curve can turn from the previous line to the next one
/// near enough to both, and also at the adjacent rows, because a single one would gain nothing.
void WallCurve::find_lines() {
  const auto n = rows();
  const double most = std::min(kRoundedSag, kRoundedRadius * edges_.back().radius);
  for (const auto& edge : edges_) {
    const auto all = bends(edge);
    for (std::size_t i = 0; i < n; ++i)
      if (all[i].still || all[i].angle > kSharp || all[i].off > most) corner_[i] = true;
  }
  if (std::ranges::find(corner_, true) == corner_.end()) return;
  const auto first = static_cast<std::size_t>(std::ranges::find(corner_, true) - corner_.begin());
  std::size_t run = 0;  // of rows that are not lines
  for (std::size_t i = first + 1; i <= first + n; ++i) {
    if (!corner_[i % n]) {
      ++run;
      continue;
    }
    if (run < kShortestRun)
      for (; run > 0; --run) corner_[(i - run) % n] = true;
    run = 0;
  }
}

/// Finds rows at which an edge turns much more than on both sides of it; if a corner lies between
/// two rows, both have its turn.
void WallCurve::find_kinks() {
  const auto n = rows();
  for (const auto& edge : edges_) {
    const auto all = bends(edge);
    const auto rate = [&](std::size_t i) { return all[i % n].rate; };
    for (std::size_t i = 0; i < n; ++i) {
      const double before = std::min(rate(i + n - 1), rate(i + n - 2));
      const double behind = std::min(rate(i + 1), rate(i + 2));
      const bool kink = rate(i) > kKink * std::max(before, behind) && all[i].off > off_rows_;
      if (all[i].still || kink) corner_[i] = true;
    }
  }
}

/// Computes slopes and, if `centred`, the distance at which the curve passes its row: on average
/// the line between two rows lies h^2 f''/12 off the curve through them.
void WallCurve::lay(bool centred) {
  const auto n = rows();
  for (auto& edge : edges_) {
    edge.knot = edge.row;
    edge.arriving.assign(n, Vector2d::Zero());
    edge.leaving.assign(n, Vector2d::Zero());
    for (std::size_t i = 0; i < n; ++i) {
      if (corner_[i]) continue;
      const auto before = (i + n - 1) % n;
      const double h = length_[before], k = length_[i];
      const Vector2d a = edge.gap[before] / h, b = edge.gap[i] / k;
      edge.arriving[i] = edge.leaving[i] = (k * a + h * b) / (h + k);
      if (centred) edge.knot[i] += (b - a) * (h * h * h + k * k * k) / (6.0 * (h + k) * (h + k));
    }
    if (!centred) bend_evenly(edge);
    for (std::size_t i = 0; i < n; ++i) {
      if (!corner_[i]) continue;
      const auto before = (i + n - 1) % n, next = (i + 1) % n;
      const Vector2d a = laid_gap(edge, before) / length_[before];
      const Vector2d b = laid_gap(edge, i) / length_[i];
      edge.arriving[i] = corner_[before] ? a : Vector2d(2.0 * a - edge.leaving[before]);
      edge.leaving[i] = corner_[next] ? b : Vector2d(2.0 * b - edge.arriving[next]);
    }
  }
}

/// Computes slopes with which the curve has one curvature at each row between two corners, and next
/// to a corner one from there to the next row: each is `put` minus its fractions of the previous
/// and the next. A row k rows away affects a slope by less than 2^-k, so a ring is solved as a line
/// that continues for kForgotten rows beyond its end.
void WallCurve::bend_evenly(Edge& edge) const {
  const auto n = rows();
  std::vector<Vector2d> put(n, Vector2d::Zero());
  std::vector<double> behind(n, 0.0);  // the factor, once the previous ones are substituted
  const auto forward = [&](std::size_t i) {
    const auto before = (i + n - 1) % n, next = (i + 1) % n;
    const double h = length_[before], k = length_[i];
    const Vector2d a = laid_gap(edge, before) / h, b = laid_gap(edge, i) / k;
    const double from = corner_[before] ? 0.0 : 1.0 / h, to = corner_[next] ? 0.0 : 1.0 / k;
    const double own = from + 1.0 / h + to + 1.0 / k - from * behind[before];
    put[i] = ((corner_[before] ? 1.0 : 3.0) / h * a + (corner_[next] ? 1.0 : 3.0) / k * b -
              from * put[before]) /
             own;
    behind[i] = to / own;
  };
  for (std::size_t i = 0; i < n + kForgotten; ++i)
    if (!corner_[i % n]) forward(i % n);
  for (std::size_t i = n + kForgotten; i-- > 0;) {
    const auto at = i % n;
    if (!corner_[at])
      edge.arriving[at] = edge.leaving[at] = put[at] - behind[at] * edge.leaving[(at + 1) % n];
  }
}

double WallCurve::along(const RowPosition& position) const {
  return along_[position.row] + position.share * length_[position.row];
}

WallCurve::Passing<Vector2d> WallCurve::pass(const Edge& edge, const RowPosition& position) const {
  const auto i = position.row;
  if (position.share == 0.0) return {edge.knot[i], edge.arriving[i], edge.leaving[i]};
  const double h = length_[i], u = position.share, v = 1.0 - u;
  const Vector2d d = laid_gap(edge, i);
  const Vector2d first = h * edge.leaving[i], last = h * edge.arriving[(i + 1) % rows()];
  const Vector2d rate =
      (6.0 * u * v * d + v * (1.0 - 3.0 * u) * first + u * (3.0 * u - 2.0) * last) / h;
  return {edge.knot[i] + u * u * (3.0 - 2.0 * u) * d + u * v * v * first - u * u * v * last, rate,
          rate};
}

WallCurve::Node WallCurve::node(const RowPosition& position) const {
  Node out{
      .position = position, .corner = position.share == 0.0 && corner_[position.row], .edges = {}};
  out.edges.reserve(edges_.size());
  for (const auto& edge : edges_) out.edges.push_back({pass(edge, position), {}});
  return out;
}

WallCurve::Node WallCurve::node_at(double from_station, double origin) const {
  double at = origin + from_station;
  const bool wrapped = at >= around_;
  if (wrapped) at -= around_;
  const auto after = std::upper_bound(along_.begin(), along_.end(), at);
  const auto row = static_cast<std::size_t>(after - along_.begin()) - 1;
  std::vector<Node> out{node({row, (at - along_[row]) / length_[row]})};
  lay_in_space(out);
  out.front().along = from_station;
  out.front().turn = wrapped ? 1.0 : 0.0;
  return std::move(out.front());
}

/// All of them at a time: side by side a sine costs a quarter.
void WallCurve::lay_in_space(std::vector<Node>& nodes) const {
  std::vector<double> phi(nodes.size()), sin(nodes.size()), cos(nodes.size());
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    for (std::size_t i = 0; i < nodes.size(); ++i) phi[i] = nodes[i].edges[k].flat.at.x();
    elementary::sincos(phi, sin, cos);
    const double r = edges_[k].radius;
    const auto& plane = edges_[k].plane;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      auto& [flat, space] = nodes[i].edges[k];
      if (plane) {
        const auto turn = elementary::sincos(plane->phi);
        const double away = elementary::tan(flat.at.x() - plane->phi);
        const double rate = plane->distance * (1.0 + away * away);
        const auto along = [&](const Vector2d& by) {
          return Vector3d(-turn.sin * rate * by.x(), turn.cos * rate * by.x(), by.y());
        };
        space = {edges_[k].in_space(flat.at), along(flat.before), along(flat.beyond)};
        continue;
      }
      const auto along = [&](const Vector2d& rate) {
        return Vector3d(-r * sin[i] * rate.x(), r * cos[i] * rate.x(), rate.y());
      };
      space = {{r * cos[i], r * sin[i], flat.at.y()}, along(flat.before), along(flat.beyond)};
    }
  }
}

Vector2d WallCurve::at(std::size_t edge, const RowPosition& position) const {
  return pass(edges_[edge], position).at;
}

std::vector<WallCurve::RowPosition> WallCurve::corners() const {
  std::vector<RowPosition> out;
  for (std::size_t i = 0; i < rows(); ++i)
    if (corner_[i]) out.push_back({i, 0.0});
  return out;
}

std::vector<WallCurve::RowPosition> WallCurve::crossings(std::size_t edge, double phi) const {
  std::vector<RowPosition> out;
  const auto& e = edges_[edge];
  for (std::size_t i = 0; i < rows(); ++i) {
    const auto next = (i + 1) % rows();
    const double from = e.knot[i].x(), to = e.knot[next].x() + (next == 0 ? turn_ : 0.0);
    for (int turn = -2; turn <= 2; ++turn) {
      const double at = phi + turn * kTwoPi;
      if ((from < at) == (to < at)) continue;
      double low = 0.0, high = 1.0;
      for (int round = 0; round < 60; ++round) {
        const double middle = 0.5 * (low + high);
        const bool first = (pass(e, {i, middle}).at.x() < at) == (from < at);
        (first ? low : high) = middle;
      }
      const bool at_row = low * length_[i] < kKnotDistance,
                 at_next = (1.0 - low) * length_[i] < kKnotDistance;
      const auto position = at_next ? RowPosition{next, 0.0} : RowPosition{i, at_row ? 0.0 : low};
      const bool known = std::ranges::any_of(out, [&](const RowPosition& other) {
        const double d = std::abs(along(position) - along(other));
        return std::min(d, around_ - d) < kKnotDistance;
      });
      if (!known) out.push_back(position);
    }
  }
  return out;
}

std::vector<WallCurve::Node> WallCurve::nodes(const std::vector<RowPosition>& stations) const {
  std::vector<Node> out;
  const double origin = along(stations.front());
  const auto add = [&](const RowPosition& position, bool station, double from) {
    out.push_back(node(position));
    out.back().station = station;
    out.back().along = along(position) - origin;
    if (out.back().along < from) {
      out.back().along += around_;
      out.back().turn = 1.0;
    }
  };
  for (const auto& position : stations) add(position, true, 0.0);
  const auto held = [&](double at) {
    const auto after = std::lower_bound(
        out.begin(), out.begin() + static_cast<std::ptrdiff_t>(stations.size()), at - kKnotDistance,
        [](const Node& node, double value) { return node.along < value; });
    const bool by_station = after != out.begin() + static_cast<std::ptrdiff_t>(stations.size()) &&
                            after->along <= at + kKnotDistance;
    return by_station || at > around_ - kKnotDistance;
  };
  for (std::size_t i = 0; i < rows(); ++i) {
    ask();
    double wide = 0.0;
    for (const auto& edge : edges_) wide = std::max(wide, std::abs(laid_gap(edge, i).x()));
    const int parts = std::max(1, static_cast<int>(std::ceil(wide / edges_.back().widest)));
    for (int part = 0; part < parts; ++part) {
      const RowPosition position{i, static_cast<double>(part) / parts};
      double at = along(position) - origin;
      if (at < 0.0) at += around_;
      if (!held(at)) add(position, false, 0.0);
    }
  }
  std::ranges::sort(out, {}, &Node::along);
  for (std::size_t i = 1; i < out.size();) {
    if (!out[i].station && out[i].along - out[i - 1].along < kKnotDistance) {
      out[i - 1].corner = out[i - 1].corner || out[i].corner;
      out.erase(out.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  ask();
  lay_in_space(out);
  auto last = out.front();
  last.along = around_;
  last.turn += 1.0;
  out.push_back(std::move(last));
  return out;
}

}  // namespace tubecut::api
