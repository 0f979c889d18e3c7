#include "core/joint/node/body_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/joint/finished.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint {
namespace {

using detail::Finished;
using detail::kLeastShared;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBeyond = 2.0;   // of a body's sizes: how far it goes on beyond its joints
constexpr int kAround = 16;       // initial cells
constexpr int kGenerators = 96;   // of each radius, whose deepest point is compared
constexpr double kSmall = 0.002;  // mm: smaller cells are not divided
constexpr std::size_t kMostCells = 30'000;
constexpr int kAlong = 24;  // pieces of a generator: the distance to an elbow has several minima

struct Interval {
  double from = -kInfinity, to = kInfinity;
  [[nodiscard]] bool empty() const { return !(from < to); }
  [[nodiscard]] Interval cut(const Interval& by) const {
    return {std::max(from, by.from), std::min(to, by.to)};
  }
};

/// The region in which a body counts.
struct Slab {
  Vector3d direction;
  double from, to;
  [[nodiscard]] Interval on(const Vector3d& start, const Vector3d& along, double reach) const {
    const double at = start.dot(direction), rise = along.dot(direction);
    const Interval wide{from - reach - at, to + reach - at};
    if (rise == 0.0) return wide.from < 0.0 && wide.to > 0.0 ? Interval{} : Interval{1.0, 0.0};
    return {std::min(wide.from / rise, wide.to / rise), std::max(wide.from / rise, wide.to / rise)};
  }
};
struct Ball {
  Vector3d center;
  double radius;
  [[nodiscard]] Interval on(const Vector3d& start, const Vector3d& along, double reach) const {
    const double middle = (center - start).dot(along);
    const double off = (start + middle * along - center).norm();
    const double square = (radius + reach - off) * (radius + reach + off);
    if (!(square > 0.0)) return {1.0, 0.0};
    return {middle - std::sqrt(square), middle + std::sqrt(square)};
  }
};
using Region = std::variant<std::monostate, Slab, Ball>;

Interval inside(const Region& region, const Vector3d& start, const Vector3d& along, double reach) {
  if (const auto* slab = std::get_if<Slab>(&region)) return slab->on(start, along, reach);
  if (const auto* ball = std::get_if<Ball>(&region)) return ball->on(start, along, reach);
  return {};
}

/// Each kind with metal as a solid in the world.
struct InWorld {
  std::optional<CutterKinds::Solid> operator()(const AxisTube& t) const {
    return TubeSolid{t.axis.point, t.axis.direction.normalized(), t.radius};
  }
  std::optional<CutterKinds::Solid> operator()(const PlaneCutter& /*plane*/) const { return {}; }
  template <class Kind>
  std::optional<CutterKinds::Solid> operator()(const Kind& kind) const {
    return kind.solid();
  }
};

struct RegionOf {
  const Body& body;

  Region operator()(const PlaneSolid& /*plane*/) const { return {}; }
  Region operator()(const ElbowSolid& e) const {
    return Ball{e.point, e.bend_radius + kBeyond * e.radius};
  }
  template <class Straight>
  Region operator()(const Straight& s) const {
    if (body.joined.empty()) return {};
    Slab out{s.direction, kInfinity, -kInfinity};
    for (const auto& [member, at] : body.joined) {
      const double there = at.dot(s.direction);
      out.from = std::min(out.from, there - kBeyond * s.scale());
      out.to = std::max(out.to, there + kBeyond * s.scale());
    }
    return out;
  }
};

/// One member and one body.
class Entry {
 public:
  Entry(const Finished& m, const CutterKinds::Solid& solid, const Region& region)
      : m_(m), solid_(solid), region_(region) {}

  /// Returns true if metal of the member is deeper in the body than `kLeastShared`.
  [[nodiscard]] bool enters() const {
    const double half = 0.5 * (m_.outer - m_.inner);
    std::vector<Cell> cells;
    for (int k = 0; k < kAround; ++k)
      cells.push_back({kTwoPi * k / kAround, kPi / kAround, m_.inner + half, half});
    for (std::size_t next = 0; next < cells.size() && next < kMostCells; ++next) {
      if (stopped()) return false;
      const auto cell = cells[next];  // a copy, because the list grows
      const double off = m_.bundle_reach(cell.rho, cell.half_rho, cell.half_phi);
      if (!(least(cell, {off, off}, off) < off - kLeastShared)) continue;
      if (least(cell, {}, 0.0) < -kLeastShared) return true;
      if (off > kSmall) cell.divide(m_.turn_of(cell.rho), cells);
    }
    return false;
  }

  [[nodiscard]] BodyOverlap deepest() const {
    constexpr double kStep = kTwoPi / kGenerators;
    BodyOverlap out;
    for (const double rho : {m_.outer, 0.5 * (m_.inner + m_.outer), m_.inner}) {
      const auto deep = [&](double phi) { return see({phi, 0.0, rho, 0.0}); };
      BodyOverlap best;
      double from = 0.0;
      for (int k = 0; k < kGenerators; ++k)
        if (keep_deeper(deep(k * kStep), best)) from = k * kStep;
      const auto between = math::golden_maximum([&](double phi) { return deep(phi).depth; },
                                                from - kStep, from + kStep);
      keep_deeper(deep(between.at), best);
      keep_deeper(best, out);
    }
    return out;
  }

 private:
  /// A bundle of generators.
  struct Cell {
    double phi, half_phi, rho, half_rho;

    void divide(double turn, std::vector<Cell>& to) const {
      auto one = *this, two = *this;
      if (half_rho > turn * half_phi) {
        one.half_rho = two.half_rho = 0.5 * half_rho;
        one.rho -= one.half_rho;
        two.rho += one.half_rho;
      } else {
        one.half_phi = two.half_phi = 0.5 * half_phi;
        one.phi -= one.half_phi;
        two.phi += one.half_phi;
      }
      to.push_back(one);
      to.push_back(two);
    }
  };

  [[nodiscard]] Interval metal(const detail::Line& line, const detail::Slack& slack,
                               double reach) const {
    if (m_.in_bore(line, slack.off, 0.0)) return {1.0, 0.0};
    const auto own = m_.span(line.rho, line.q, slack);
    return Interval{own.from, own.to}.cut(inside(region_, m_.point(line, 0.0), m_.axis, reach));
  }

  /// Returns the smallest signed distance on the bundle's middle generator.
  [[nodiscard]] double least(const Cell& cell, const detail::Slack& slack, double reach) const {
    const auto line = m_.line(cell.phi, cell.rho);
    const auto z = metal(line, slack, reach);
    if (z.empty()) return kInfinity;
    return by_kind(solid_, [&](const auto& solid) {
      return solid.least_distance(m_.point(line, z.from), m_.point(line, z.to));
    });
  }

  static bool keep_deeper(const BodyOverlap& one, BodyOverlap& out) {
    if (!(one.depth > out.depth)) return false;
    out = one;
    return true;
  }

  /// Returns the deepest point of a generator.
  [[nodiscard]] BodyOverlap see(const Cell& cell) const {
    const auto line = m_.line(cell.phi, cell.rho);
    const auto z = metal(line, {}, 0.0);
    if (z.empty()) return {};
    const auto depth = [&](double at) {
      return by_kind(solid_,
                     [&](const auto& solid) { return -solid.distance(m_.point(line, at)); });
    };
    const double step = (z.to - z.from) / kAlong;
    double best = z.from;
    for (int k = 1; k <= kAlong; ++k)
      if (depth(z.from + k * step) > depth(best)) best = z.from + k * step;
    const auto top =
        math::golden_maximum(depth, std::max(z.from, best - step), std::min(z.to, best + step));
    if (depth(top.at) > depth(best)) best = top.at;
    return {.depth = depth(best), .at = m_.point(line, best)};
  }

  const Finished& m_;
  const CutterKinds::Solid& solid_;
  const Region& region_;
};

/// Returns true if the member may enter the body, from its axis alone.
bool near(const Member& m, const CutterKinds::Solid& solid, const Region& region) {
  const Vector3d along = (m.finish - m.start).normalized();
  const auto z =
      Interval{0.0, (m.finish - m.start).norm()}.cut(inside(region, m.start, along, m.reach()));
  if (z.empty()) return false;
  return by_kind(solid, [&](const auto& one) {
    const double from_axis = one.least_distance(m.start + z.from * along, m.start + z.to * along);
    return from_axis < m.reach() - kLeastShared;
  });
}

/// Returns true for a liner, and for a member that continues the body.
bool along_inside(const Member& m, const CutterKinds::Solid& solid) {
  return by_kind(solid, [&](const auto& one) {
    return std::max({one.distance(m.start), one.distance(0.5 * (m.start + m.finish)),
                     one.distance(m.finish)}) <= 0.0;
  });
}

}  // namespace

Result<std::vector<BodyOverlap>> overlaps_with(const std::vector<Body>& bodies,
                                               const NodeSpec& spec, const Nodes& nodes,
                                               const Beside& beside) {
  std::vector<BodyOverlap> out;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto solid = by_kind(bodies[b].partner, InWorld{});
    if (!solid) continue;
    const auto region = by_kind(*solid, RegionOf{bodies[b]});
    for (std::size_t i = 0; i < spec.members.size(); ++i) {
      if (stopped()) return fail({.code = ErrorCode::cancelled});
      const auto& m = spec.members[i];
      if (std::ranges::find(bodies[b].joined, i, &std::pair<std::size_t, Vector3d>::first) !=
              bodies[b].joined.end() ||
          !near(m, *solid, region) || along_inside(m, *solid))
        continue;
      const auto member = detail::finished(spec, nodes, i, beside);
      const Entry entry(member, *solid, region);
      if (!entry.enters()) continue;
      auto one = entry.deepest();
      one.member = i;
      one.body = b;
      out.push_back(one);
      if (out.size() > kMostOverlaps) return too_many_overlaps(out.size());
    }
  }
  std::ranges::sort(out, {}, [](const BodyOverlap& o) { return std::pair{o.member, o.body}; });
  return out;
}

}  // namespace tubecut::joint
