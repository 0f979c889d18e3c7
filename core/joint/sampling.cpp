#include "core/joint/sampling.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/length.hpp"
#include "core/joint/stations.hpp"

namespace tubecut::joint {
namespace {

constexpr double kWidest = 10.0 * kRadPerDeg;  // before any deviation is measured
constexpr int kProbes = 7;
constexpr int kHalvings = 48;
constexpr double kSameNode = 1e-6;  // mm, developed
constexpr double kAtEvent = 1e-9;   // rad; a bare grid point this near an event lies on it

struct Point {
  double phi, z;
};

/// Refines one segment, or a part of it between phases that must be nodes.
class Refiner {
 public:
  Refiner(const Contour& contour, const Tolerance& tolerance, std::size_t max_nodes)
      : contour_(contour), tolerance_(tolerance), max_nodes_(max_nodes) {}

  /// Appends the points strictly between `from` and `to`.
  void refine(std::size_t cutter, Point from, Point to) {
    cutter_ = cutter;
    const double width = to.phi - from.phi;
    const int parts = std::max(1, static_cast<int>(std::ceil(width / kWidest - 1e-9)));
    Point left = from;
    for (int k = 1; k <= parts; ++k) {
      const Point right = k == parts ? to : at(from.phi + width * k / parts);
      halve(left, right, kHalvings);
      if (k < parts) points.push_back(right);
      left = right;
    }
  }

  [[nodiscard]] bool ends() const { return points.size() > max_nodes_ || stopped(); }
  [[nodiscard]] Point at(std::size_t cutter, double phi) const {
    return {phi, continued_sheet(contour_.cutters[cutter], generator_at(contour_.radius, phi))};
  }

  std::vector<Point> points;

 private:
  [[nodiscard]] Point at(double phi) const { return at(cutter_, phi); }

  [[nodiscard]] Eigen::Vector3d placed(const Point& p) const {
    if (tolerance_.metric == Metric::developed) return {contour_.radius * p.phi, p.z, 0.0};
    const auto g = generator_at(contour_.radius, p.phi);
    return {g.radius * g.cos_phi, g.radius * g.sin_phi, p.z};
  }

  [[nodiscard]] bool straight(const Point& a, const Point& b) const {
    const Eigen::Vector3d from = placed(a);
    const Eigen::Vector3d along = (placed(b) - from).normalized();
    for (int k = 1; k <= kProbes; ++k) {
      const double phi = a.phi + (b.phi - a.phi) * k / (kProbes + 1);
      const Eigen::Vector3d to = placed(at(phi)) - from;
      if ((to - to.dot(along) * along).norm() > tolerance_.value) return false;
    }
    return true;
  }

  void halve(const Point& a, const Point& b, int halvings) {
    if (halvings == 0 || ends() || straight(a, b)) return;
    const Point mid = at(0.5 * (a.phi + b.phi));
    halve(a, mid, halvings - 1);
    points.push_back(mid);
    halve(mid, b, halvings - 1);
  }

  const Contour& contour_;
  const Tolerance& tolerance_;
  std::size_t max_nodes_;
  std::size_t cutter_ = 0;
};

double wrapped(double phi) { return phi < kTwoPi ? phi : phi - kTwoPi; }

Node smooth_node(double phi, double z, std::size_t cutter) {
  return {.phi = wrapped(phi), .z = z, .before = cutter, .after = cutter};
}

void append_event(std::vector<Node>& nodes, const Event& event) {
  Node node{.phi = event.phi, .z = event.z_from, .before = event.from, .after = event.to};
  if (event.kind == EventKind::jump) {
    nodes.push_back({.phi = event.phi,
                     .z = event.z_from,
                     .before = event.from,
                     .after = event.from,
                     .kind = NodeKind::jump});
    nodes.push_back({.phi = event.phi,
                     .z = event.z_to,
                     .before = event.to,
                     .after = event.to,
                     .kind = NodeKind::jump});
    return;
  }
  node.kind = event.kind == EventKind::kink ? NodeKind::kink : NodeKind::junction;
  nodes.push_back(node);
}

/// Returns the phases within a segment that must be nodes, ascending, including its two ends.
std::vector<double> stations(const Segment& segment, std::span<const double> also, double apart) {
  std::vector<double> out;
  for (const double phi : also) {
    const double here = phi < segment.from ? phi + kTwoPi : phi;
    if (here > segment.from + apart && here < segment.to - apart) out.push_back(here);
  }
  std::ranges::sort(out);
  std::vector<double> kept{segment.from};
  for (const double phi : out)
    if (phi > kept.back() + apart) kept.push_back(phi);
  kept.push_back(segment.to);
  return kept;
}

Point end_point(const Contour& contour, const Segment& segment, const Refiner& refiner,
                double phi) {
  const auto k = static_cast<std::size_t>(&segment - contour.segments.data());
  if (!contour.events.empty() && phi == segment.from) return {phi, contour.events[k].z_to};
  if (!contour.events.empty() && phi == segment.to)
    return {phi, contour.events[(k + 1) % contour.events.size()].z_from};
  return refiner.at(segment.cutter, phi);
}

void append_segment(std::vector<Node>& nodes, const Contour& contour, const Segment& segment,
                    Refiner& refiner, std::span<const double> also) {
  const auto phases = stations(segment, also, kSameNode / contour.radius);
  for (std::size_t k = 0; k + 1 < phases.size(); ++k) {
    const auto from = end_point(contour, segment, refiner, phases[k]);
    const auto to = end_point(contour, segment, refiner, phases[k + 1]);
    if (k > 0 || contour.events.empty())
      nodes.push_back(smooth_node(from.phi, from.z, segment.cutter));
    refiner.points.clear();
    refiner.refine(segment.cutter, from, to);
    for (const auto& p : refiner.points) nodes.push_back(smooth_node(p.phi, p.z, segment.cutter));
  }
}

tl::unexpected<Error> too_many(std::size_t got, std::size_t limit) {
  return fail({.code = ErrorCode::too_many_nodes,
               .member = "sampling",
               .got = static_cast<double>(got),
               .limit = static_cast<double>(limit)});
}

Result<std::vector<Node>> adaptive_nodes(const Contour& contour, const Sampling& sampling,
                                         std::span<const double> also) {
  std::vector<Node> nodes;
  Refiner refiner(contour, *sampling.tolerance, sampling.max_nodes);
  for (std::size_t k = 0; k < contour.segments.size(); ++k) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (!contour.events.empty()) append_event(nodes, contour.events[k]);
    append_segment(nodes, contour, contour.segments[k], refiner, also);
    if (nodes.size() > sampling.max_nodes) return too_many(nodes.size(), sampling.max_nodes);
  }
  // The last segment's nodes beyond 2 pi come first.
  std::ranges::stable_sort(nodes, {}, &Node::phi);
  return nodes;
}

double uniform_phase(std::size_t i, std::size_t n) {
  return kTwoPi * static_cast<double>(i) / static_cast<double>(n);
}

/// A bare grid point that lies on a junction or kink has two sides like the event itself.
void mark_event(const Contour& contour, Node& node) {
  for (const auto& event : contour.events) {
    const double apart = std::abs(event.phi - node.phi);
    if (std::min(apart, kTwoPi - apart) > kAtEvent || event.kind == EventKind::jump) continue;
    node.kind = event.kind == EventKind::kink ? NodeKind::kink : NodeKind::junction;
    node.before = event.from;
    node.after = event.to;
  }
}

std::vector<Node> uniform_nodes(const Contour& contour, std::size_t n) {
  std::vector<Node> nodes;
  if (stopped()) return nodes;
  std::vector<double> phases(n);
  for (std::size_t i = 0; i < n; ++i) phases[i] = uniform_phase(i, n);
  const auto contacts = contacts_at(contour, stations_at(contour.radius, phases), phases);
  nodes.reserve(n);
  for (std::size_t i = 0; i < n && !stopped(); ++i) {
    nodes.push_back(smooth_node(phases[i], contacts.z[i], contacts.cutter[i]));
    mark_event(contour, nodes.back());
  }
  return nodes;
}

/// Adds the uniform points that are not already nodes, the circle's seam included.
std::vector<Node> with_uniform(const Contour& contour, std::vector<Node> nodes, std::size_t n) {
  const double apart = kSameNode / contour.radius;
  const auto taken = [&](double phi) {
    const auto near = std::ranges::lower_bound(nodes, phi - apart, {}, &Node::phi);
    if (near != nodes.end() && near->phi <= phi + apart) return true;
    return nodes.front().phi + kTwoPi <= phi + apart || nodes.back().phi - kTwoPi >= phi - apart;
  };
  std::vector<Node> added;
  for (auto& node : uniform_nodes(contour, n))
    if (!taken(node.phi)) added.push_back(node);
  nodes.insert(nodes.end(), added.begin(), added.end());
  std::ranges::stable_sort(nodes, {}, &Node::phi);
  return nodes;
}

Result<Samples> measured(const Contour& contour, std::vector<Node> nodes) {
  std::vector<double> phases;
  phases.reserve(nodes.size());
  for (const auto& node : nodes) phases.push_back(node.phi);
  const auto lengths = lengths_along(contour, phases);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k].length = lengths[k];
  return Samples{std::move(nodes), lengths.back(), kTwoPi * contour.radius};
}

}  // namespace

Result<Samples> sample(const Contour& contour, const Sampling& sampling,
                       std::span<const double> also) {
  const auto& tolerance = sampling.tolerance;
  if (tolerance ? !(tolerance->value > 0.0) : sampling.uniform_points == 0)
    return fail({.code = ErrorCode::out_of_range, .member = "sampling"});
  if (sampling.uniform_points > sampling.max_nodes)
    return too_many(sampling.uniform_points, sampling.max_nodes);
  if (!tolerance) return measured(contour, uniform_nodes(contour, sampling.uniform_points));
  TRY(auto nodes, adaptive_nodes(contour, sampling, also));
  auto all = with_uniform(contour, std::move(nodes), sampling.uniform_points);
  if (all.size() > sampling.max_nodes) return too_many(all.size(), sampling.max_nodes);
  return measured(contour, std::move(all));
}

BothSides hits_at(const Contour& contour, const Node& node) {
  const auto line = generator_at(contour.radius, node.phi);
  const auto& before = contour.cutters[node.before];
  if (node.kind == NodeKind::kink)
    return {hit_at_corner(before, line, Side::before), hit_at_corner(before, line, Side::after)};
  const auto one = continued_hit(before, line);
  return {one, node.before == node.after ? one : continued_hit(contour.cutters[node.after], line)};
}

}  // namespace tubecut::joint
