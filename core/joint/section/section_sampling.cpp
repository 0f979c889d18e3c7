#include "core/joint/section/section_sampling.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/section/section_length.hpp"

namespace tubecut::joint {
namespace {

constexpr double kWidestTurn = 10.0 * kRadPerDeg;  // of the normal, before a deviation is measured
constexpr double kWidestShare = 1.0 / 36.0;        // of the girth, likewise on a flat
constexpr int kProbes = 7;
constexpr int kHalvings = 48;
constexpr double kSameNode = 1e-6;  // mm
constexpr double kAtEvent = 1e-9;   // of the girth; a bare grid point so near an event lies on it

struct Point {
  double s, z;
};

/// Refines a part of one segment.
class Refiner {
 public:
  Refiner(const SectionContour& contour, const Tolerance& tolerance, std::size_t max_nodes)
      : contour_(contour), tolerance_(tolerance), max_nodes_(max_nodes) {}

  /// Appends the points strictly between `from` and `to`.
  void refine(std::size_t cutter, Point from, Point to) {
    cutter_ = cutter;
    const double curvature = contour_.curve.at(0.5 * (from.s + to.s)).curvature;
    const double widest =
        curvature > 0.0 ? kWidestTurn / curvature : kWidestShare * contour_.curve.girth();
    const double width = to.s - from.s;
    const int parts = std::max(1, static_cast<int>(std::ceil(width / widest - 1e-9)));
    Point left = from;
    for (int k = 1; k <= parts; ++k) {
      const Point right = k == parts ? to : at(cutter, from.s + width * k / parts);
      halve(left, right, kHalvings);
      if (k < parts) points.push_back(right);
      left = right;
    }
  }

  [[nodiscard]] Point at(std::size_t cutter, double s) const {
    return {s, contour_.height(cutter, contour_.curve.at(s))};
  }

  std::vector<Point> points;

 private:
  [[nodiscard]] Eigen::Vector3d placed(const Point& p) const {
    if (tolerance_.metric == Metric::developed) return {p.s, p.z, 0.0};
    const auto place = contour_.curve.at(p.s).point;
    return {place.x(), place.y(), p.z};
  }

  [[nodiscard]] bool straight(const Point& a, const Point& b) const {
    const Eigen::Vector3d from = placed(a);
    const Eigen::Vector3d along = (placed(b) - from).normalized();
    for (int k = 1; k <= kProbes; ++k) {
      const double s = a.s + (b.s - a.s) * k / (kProbes + 1);
      const Eigen::Vector3d to = placed(at(cutter_, s)) - from;
      if ((to - to.dot(along) * along).norm() > tolerance_.value) return false;
    }
    return true;
  }

  void halve(const Point& a, const Point& b, int halvings) {
    if (halvings == 0 || points.size() > max_nodes_ || straight(a, b)) return;
    const Point mid = at(cutter_, 0.5 * (a.s + b.s));
    halve(a, mid, halvings - 1);
    points.push_back(mid);
    halve(mid, b, halvings - 1);
  }

  const SectionContour& contour_;
  const Tolerance& tolerance_;
  std::size_t max_nodes_;
  std::size_t cutter_ = 0;
};

tl::unexpected<Error> too_many(std::size_t got, std::size_t limit) {
  return fail({.code = ErrorCode::too_many_nodes,
               .member = "sampling",
               .got = static_cast<double>(got),
               .limit = static_cast<double>(limit)});
}

SectionNodeKind kind_of(const SectionEvent& event) {
  switch (event.kind) {
    case SectionEventKind::junction:
      return SectionNodeKind::junction;
    case SectionEventKind::jump:
      return SectionNodeKind::jump;
    case SectionEventKind::kink:
      return SectionNodeKind::kink;
    case SectionEventKind::seam:
      return SectionNodeKind::seam;
  }
  return SectionNodeKind::smooth;
}

/// Makes the nodes of one contour.
class Nodes {
 public:
  Nodes(const SectionContour& contour, const Sampling& sampling)
      : contour_(contour), sampling_(sampling), girth_(contour.curve.girth()) {}

  Result<std::vector<SectionNode>> by_tolerance(std::span<const double> also) {
    Refiner refiner(contour_, *sampling_.tolerance, sampling_.max_nodes);
    for (std::size_t k = 0; k < contour_.segments.size(); ++k) {
      if (stopped()) return fail({.code = ErrorCode::cancelled});
      if (!contour_.events.empty()) append(contour_.events[k]);
      append(k, refiner, also);
      if (nodes_.size() > sampling_.max_nodes) return too_many(nodes_.size(), sampling_.max_nodes);
    }
    // The last segment's nodes beyond the datum come first.
    std::ranges::stable_sort(nodes_, {}, &SectionNode::s);
    add_grid();
    return std::move(nodes_);
  }

  std::vector<SectionNode> grid() {
    for (std::size_t i = 0; i < sampling_.uniform_points; ++i) {
      const double s =
          girth_ * static_cast<double>(i) / static_cast<double>(sampling_.uniform_points);
      const auto contact = contact_at(contour_, contour_.curve.at(s));
      nodes_.push_back(smooth(s, contact.z, contact.cutter));
      mark_event(nodes_.back());
    }
    return std::move(nodes_);
  }

 private:
  [[nodiscard]] SectionNode smooth(double s, double z, std::size_t cutter) const {
    return {.s = s < girth_ ? s : s - girth_, .z = z, .before = cutter, .after = cutter};
  }
  [[nodiscard]] double distance(double a, double b) const {
    const double d = std::abs(a - b);
    return std::min(d, girth_ - d);
  }

  void append(const SectionEvent& event) {
    SectionNode node{.s = event.s,
                     .z = event.z_from,
                     .before = event.from,
                     .after = event.to,
                     .kind = kind_of(event)};
    if (event.kind != SectionEventKind::jump) return nodes_.push_back(node);
    node.after = event.from;
    nodes_.push_back(node);
    node.z = event.z_to;
    node.before = node.after = event.to;
    nodes_.push_back(node);
  }

  /// The places within segment k that must be nodes, ascending, its two ends included.
  [[nodiscard]] std::vector<double> stops(const SectionSegment& segment,
                                          std::span<const double> also) const {
    std::vector<double> out;
    for (const double s : also) {
      const double here = s < segment.from ? s + girth_ : s;
      if (here > segment.from + kSameNode && here < segment.to - kSameNode) out.push_back(here);
    }
    std::ranges::sort(out);
    std::vector<double> kept{segment.from};
    for (const double s : out)
      if (s > kept.back() + kSameNode) kept.push_back(s);
    kept.push_back(segment.to);
    return kept;
  }

  void append(std::size_t k, Refiner& refiner, std::span<const double> also) {
    const auto& segment = contour_.segments[k];
    const auto& events = contour_.events;
    const auto end_point = [&](double s) -> Point {
      if (!events.empty() && s == segment.from) return {s, events[k].z_to};
      if (!events.empty() && s == segment.to) return {s, events[(k + 1) % events.size()].z_from};
      return refiner.at(segment.cutter, s);
    };
    const auto places = stops(segment, also);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const auto from = end_point(places[i]), to = end_point(places[i + 1]);
      if (i > 0 || events.empty()) nodes_.push_back(smooth(from.s, from.z, segment.cutter));
      refiner.points.clear();
      refiner.refine(segment.cutter, from, to);
      for (const auto& p : refiner.points) nodes_.push_back(smooth(p.s, p.z, segment.cutter));
    }
  }

  /// The uniform points that are not already nodes.
  void add_grid() {
    const auto found = std::move(nodes_);
    nodes_.clear();
    auto even = grid();
    nodes_ = found;
    for (const auto& node : even) {
      const auto next = std::ranges::lower_bound(found, node.s, {}, &SectionNode::s);
      const auto& after = next != found.end() ? *next : found.front();
      const auto& before = next != found.begin() ? *(next - 1) : found.back();
      if (std::min(distance(after.s, node.s), distance(before.s, node.s)) > kSameNode)
        nodes_.push_back(node);
    }
    std::ranges::stable_sort(nodes_, {}, &SectionNode::s);
  }

  /// A bare grid point that lies on an event has two sides like the event itself.
  void mark_event(SectionNode& node) const {
    for (const auto& event : contour_.events) {
      if (event.kind == SectionEventKind::jump || distance(event.s, node.s) > kAtEvent * girth_)
        continue;
      node.kind = kind_of(event);
      node.before = event.from;
      node.after = event.to;
    }
  }

  const SectionContour& contour_;
  const Sampling& sampling_;
  double girth_;
  std::vector<SectionNode> nodes_;
};

}  // namespace

Result<SectionSamples> sample(const SectionContour& contour, const Sampling& sampling,
                              std::span<const double> also) {
  const auto& tolerance = sampling.tolerance;
  if (tolerance ? !(tolerance->value > 0.0) : sampling.uniform_points == 0)
    return fail({.code = ErrorCode::out_of_range, .member = "sampling"});
  if (sampling.uniform_points > sampling.max_nodes)
    return too_many(sampling.uniform_points, sampling.max_nodes);
  Nodes make(contour, sampling);
  SectionSamples out;
  if (tolerance) {
    TRY(out.nodes, make.by_tolerance(also));
  } else {
    out.nodes = make.grid();
  }
  if (out.nodes.size() > sampling.max_nodes) return too_many(out.nodes.size(), sampling.max_nodes);
  std::vector<double> places;
  places.reserve(out.nodes.size());
  for (const auto& node : out.nodes) places.push_back(node.s);
  const auto lengths = lengths_along(contour, places);
  for (std::size_t k = 0; k < out.nodes.size(); ++k) out.nodes[k].length = lengths[k];
  out.true_length = lengths.back();
  return out;
}

}  // namespace tubecut::joint
