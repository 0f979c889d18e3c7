#include "core/part/webs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::part {
namespace {

using Point = Eigen::Vector2d;  // on the developed wall, mm

constexpr double kFar = std::numeric_limits<double>::infinity();

struct LineSegment {
  Point a, b;
};

/// A bounding box on the developed wall.
struct WebBox {
  Point least = Point::Constant(kFar), most = Point::Constant(-kFar);

  void take(const Point& p) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  /// Returns a lower bound of the distance to another box at `shift` around the tube.
  [[nodiscard]] double apart(const WebBox& other, double shift) const {
    const double x =
        std::max({0.0, other.least.x() + shift - most.x(), least.x() - other.most.x() - shift});
    const double y = std::max({0.0, other.least.y() - most.y(), least.y() - other.most.y()});
    return elementary::hypot(x, y);
  }
};

struct Way {
  double length = kFar;
  Point from = Point::Zero(), to = Point::Zero();
};

/// Computes the shortest path from a point to a segment.
Way way(const Point& p, const LineSegment& to) {
  const Point along = to.b - to.a;
  const double square = along.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - to.a).dot(along) / square, 0.0, 1.0) : 0.0;
  const Point foot = to.a + t * along;
  return {(foot - p).norm(), p, foot};
}

double side(const LineSegment& of, const Point& p) {
  const Point along = of.b - of.a, from = p - of.a;
  return along.x() * from.y() - along.y() * from.x();
}

Way way(const LineSegment& one, const LineSegment& other) {
  const double a = side(one, other.a), b = side(one, other.b);
  const double c = side(other, one.a), d = side(other, one.b);
  if (a * b < 0.0 && c * d < 0.0) {
    const Point met = other.a + a / (a - b) * (other.b - other.a);
    return {0.0, met, met};
  }
  Way out;
  for (const auto& p : {one.a, one.b})
    if (const auto w = way(p, other); w.length < out.length) out = w;
  for (const auto& p : {other.a, other.b})
    if (const auto w = way(p, one); w.length < out.length) out = {w.length, w.to, w.from};
  return out;
}

/// A polyline in blocks of neighbouring segments, each with a bounding box.
class Line {
 public:
  Line(std::vector<Point> points, bool closed) : points_(std::move(points)) {
    const auto n = points_.size();
    for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
      if (i % kBlock == 0) boxes_.emplace_back();
      pieces_.push_back({points_[i], points_[(i + 1) % n]});
      for (const auto& p : {pieces_[i].a, pieces_[i].b}) {
        boxes_.back().take(p);
        whole_.take(p);
      }
    }
  }

  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

  /// Returns its extent around the tube.
  [[nodiscard]] std::pair<double, double> round() const {
    return {whole_.least.x(), whole_.most.x()};
  }
  /// Returns a lower bound of the distance to another polyline at `shift` around the tube.
  [[nodiscard]] double apart(const Line& other, double shift) const {
    return whole_.apart(other.whole_, shift);
  }
  /// Returns true if a point is inside the closed line.
  [[nodiscard]] bool holds(const Point& p) const {
    bool inside = false;
    for (const auto& [a, b] : pieces_)
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        inside = !inside;
    return inside;
  }

  /// Replaces `best` by the shortest path to another polyline, at `shift` around the tube, if that
  /// is shorter.
  /// Cost  the square of the blocks, and the segments of near blocks.
  void shorten(const Line& other, double shift, Way& best, const std::stop_token& stop) const {
    const double within = reach(other, shift);
    for (std::size_t i = 0; i < boxes_.size(); ++i)
      for (std::size_t j = 0; j < other.boxes_.size(); ++j) {
        if (boxes_[i].apart(other.boxes_[j], shift) > std::min(best.length, within)) continue;
        if (stop.stop_requested() || best.length == 0.0) return;
        shorten(block(i), other.block(j), shift, best);
      }
  }

 private:
  static constexpr std::size_t kBlock = 32;

  [[nodiscard]] std::span<const LineSegment> block(std::size_t i) const {
    const auto from = i * kBlock;
    return std::span(pieces_).subspan(from, std::min(kBlock, pieces_.size() - from));
  }
  /// Returns an upper bound of the shortest path: between the blocks' first points.
  [[nodiscard]] double reach(const Line& other, double shift) const {
    double out = kFar;
    for (std::size_t i = 0; i < pieces_.size(); i += kBlock)
      for (std::size_t j = 0; j < other.pieces_.size(); j += kBlock)
        out = std::min(out, (other.pieces_[j].a + Point(shift, 0.0) - pieces_[i].a).squaredNorm());
    return std::sqrt(out) * (1.0 + 1e-12);  // because rounding must not exclude the pair itself
  }
  static void shorten(std::span<const LineSegment> one, std::span<const LineSegment> other,
                      double shift, Way& best) {
    const Point by(shift, 0.0);
    for (const auto& piece : one)
      for (const auto& [a, b] : other)
        if (const auto w = way(piece, LineSegment{a + by, b + by}); w.length < best.length)
          best = w;
  }

  std::vector<Point> points_;
  std::vector<LineSegment> pieces_;
  std::vector<WebBox> boxes_;
  WebBox whole_;
};

/// One of the two surfaces of the wall, developed.
struct Wall {
  double radius;
  bool outer;

  [[nodiscard]] Line of(const bevel::Hole& hole) const {
    const auto& phi = outer ? hole.phi : hole.phi_inner;
    const auto& z = outer ? hole.z : hole.z_inner;
    std::vector<Point> out;
    for (std::size_t i = 0; i < phi.size(); ++i) out.emplace_back(radius * phi[i], z[i]);
    return {std::move(out), true};
  }
  /// Returns an end's edge over three revolutions, because a hole's phases extend that far.
  [[nodiscard]] Line of(const bevel::Table& end) const {
    std::vector<Point> out;
    const auto& z = outer ? end.z_outer : end.z_inner;
    for (const double turn : {-kTwoPi, 0.0, kTwoPi})
      for (std::size_t i = 0; i < z.size(); ++i)
        out.emplace_back(radius * (end.phi[i] + turn), z[i]);
    return {std::move(out), false};
  }
  [[nodiscard]] EdgePoint place(const Point& p) const {
    return {math::whole_turn(p.x() / radius), p.y()};
  }
};

/// Finds the narrowest webs on both surfaces.
class Search {
 public:
  Search(const Part& part, const std::stop_token& stop) : part_(part), stop_(stop) {}

  void on(const Wall& wall, Webs& out) const {
    std::vector<Line> holes;
    for (const auto& placed : part_.holes) {
      if (stop_.stop_requested()) return;
      holes.push_back(wall.of(placed.hole));
    }
    between(wall, holes, out);
    for (const bool finish : {false, true}) to_end(wall, holes, finish, out);
    to_seam(wall, holes, out);
  }

 private:
  static void keep(const Way& way, const Wall& wall, Web web, std::optional<Web>& best) {
    if (way.length == kFar || (best && best->width <= way.length)) return;
    web.width = way.length;
    web.radius = wall.radius;
    web.from = wall.place(way.from);
    web.to = wall.place(way.to);
    best = web;
  }

  void between(const Wall& wall, const std::vector<Line>& holes, Webs& out) const {
    for (std::size_t i = 0; i < holes.size(); ++i)
      for (std::size_t j = i + 1; j < holes.size(); ++j) {
        Way best{.length = out.between_holes ? out.between_holes->width : kFar};
        bool shorter = false;
        for (int turn = -2; turn <= 2; ++turn) {
          const double shift = turn * kTwoPi * wall.radius;
          if (stop_.stop_requested() || !(holes[i].apart(holes[j], shift) < best.length)) continue;
          const double before = best.length;
          if (within(holes[i], holes[j], shift))
            best = {0.0, holes[j].points().front(), holes[j].points().front()};
          else
            holes[i].shorten(holes[j], shift, best, stop_);
          shorter = shorter || best.length < before;
        }
        if (shorter) keep(best, wall, {.hole = i, .other = j}, out.between_holes);
      }
  }
  static bool within(const Line& a, const Line& b, double shift) {
    const Point by(shift, 0.0);
    return a.holds(b.points().front() + by) || b.holds(a.points().front() - by);
  }

  void to_end(const Wall& wall, const std::vector<Line>& holes, bool finish, Webs& out) const {
    const auto& table = (finish ? part_.finish : part_.start).table;
    const part::Edge edge{table.phi, wall.outer ? table.z_outer : table.z_inner};
    if (stop_.stop_requested()) return;
    const auto end = wall.of(table);
    for (std::size_t i = 0; i < holes.size() && !stop_.stop_requested(); ++i) {
      Way best{.length = out.to_end ? out.to_end->width : kFar};
      const double before = best.length;
      // Beyond the cut, no wall is left.
      const auto p = holes[i].points().front();
      const auto there = edge.at(p.x() / wall.radius);
      if (finish ? p.y() >= there.low : p.y() <= there.high)
        best = {0.0, p, p};
      else if (holes[i].apart(end, 0.0) < best.length)
        holes[i].shorten(end, 0.0, best, stop_);
      if (best.length < before)
        keep(best, wall, {.hole = i, .beside = finish ? Beside::finish : Beside::start},
             out.to_end);
    }
  }

  static void to_seam(const Wall& wall, const std::vector<Line>& holes, Webs& out) {
    const double girth = kTwoPi * wall.radius;
    for (std::size_t i = 0; i < holes.size(); ++i) {
      const auto [least, most] = holes[i].round();
      const double next = girth * std::ceil(least / girth);
      const double way = next <= most ? 0.0 : std::min(next - most, least - (next - girth));
      if (!out.to_seam || way < out.to_seam->girth) out.to_seam = {way, i};
    }
  }

  const Part& part_;
  const std::stop_token& stop_;
};

}  // namespace

const std::optional<Web>& Webs::narrowest() const {
  const bool end = to_end && (!between_holes || to_end->width < between_holes->width);
  return end ? to_end : between_holes;
}

Webs webs(const PartSpec& spec, const Part& part, const std::stop_token& stop) {
  Webs out;
  const Search search(part, stop);
  search.on({spec.target.outer_radius, true}, out);
  search.on({spec.target.inner_radius(), false}, out);
  return out;
}

}  // namespace tubecut::part
