#include "core/joint/node/overlap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/joint/finished.hpp"
#include "core/joint/node/node_parts.hpp"

namespace tubecut::joint {
namespace {

using detail::Finished;
using Eigen::Vector3d;

constexpr int kGenerators = 48;      // of a wall, sampled for its depth
constexpr int kAlong = 12;           // points of a generator inside the other member
constexpr double kInfinite = 1e300;  // mm
constexpr double kThin = 0.02;       // of both radii: features that the points of `deepen` may miss
constexpr int kHalvings = 14;        // of the steps of the search for the deepest point
constexpr int kMoves = 24;           // with one step size

/// Returns the depth of a point inside the finished member, with its bore filled.
double depth(const Finished& m, const Vector3d& p) {
  const Vector3d from = p - m.start;
  const double z = from.dot(m.axis);
  const Vector3d beside = from - z * m.axis;
  const double rho = beside.norm();
  const Vector3d q = rho > 0.0 ? Vector3d(beside / rho) : m.side(0.0);
  const auto span = m.span(m.section ? rho : std::clamp(rho, m.inner, m.outer), q);
  return std::min({m.section ? m.below(p) : m.outer - rho, z - span.from, span.to - z});
}

/// The segment of a generator of `m` inside the other's extended outside and between its own cuts;
/// and its smallest distance to that, or of a section any number of the same sign.
struct Reach {
  double from, to, clearance;
};
Reach reach(const Finished& m, const Finished& other, double rho, const Vector3d& q) {
  const auto own = m.span(rho, q);
  const Vector3d p = m.point(rho, q, 0.0) - other.start;
  const Vector3d across = m.axis - m.axis.dot(other.axis) * other.axis;
  const Vector3d beside = p - p.dot(other.axis) * other.axis;
  const double square = across.squaredNorm();
  if (!(own.from < own.to)) return {0.0, 0.0, kInfinite};
  if (other.section) {
    const auto& s = *other.section;
    if (square < kParallel * kParallel)
      return {own.from, own.to, s.outside.distance(s.across(beside))};
    const auto chord = s.outside.chord(s.across(beside), s.across(across));
    const double from = std::max(own.from, chord.from), to = std::min(own.to, chord.to);
    return {from, to, from < to ? -1.0 : kInfinite};
  }
  if (square < kParallel * kParallel) return {own.from, own.to, beside.norm() - other.outer};
  const double middle = -beside.dot(across) / square;
  const double nearest = std::clamp(middle, own.from, own.to);
  const double least = (beside + middle * across).squaredNorm();
  const double half = std::sqrt(std::max(0.0, other.outer * other.outer - least) / square);
  return {std::max(own.from, middle - half), std::min(own.to, middle + half),
          (beside + nearest * across).norm() - other.outer};
}

std::array<double, 3> walls(const Finished& m) {
  return {m.outer, 0.5 * (m.inner + m.outer), m.inner};
}

/// The deepest point of one member's metal in the other.
struct Deepest {
  double depth = 0.0;
  Vector3d at = Vector3d::Zero();
};

/// A point in a member's wall: generator as of Finished::line, and the fraction of its segment
/// inside the other.
struct MetalPoint {
  double rho, phi, share;
};

void see(const Finished& m, const Finished& other, const MetalPoint& place, Deepest& out) {
  const auto line = m.line(place.phi, place.rho);
  if (m.in_bore(line, 0.0, 0.0)) return;
  const auto r = reach(m, other, line.rho, line.q);
  if (!(r.clearance < 0.0 && r.from < r.to)) return;
  const Vector3d p = m.point(line, r.from + place.share * (r.to - r.from));
  const double deep = depth(other, p);
  if (deep <= out.depth) return;
  out.depth = deep;
  out.at = p;
}

/// Climbs from a point by steps that halve.
void climb(const Finished& m, const Finished& other, MetalPoint from, Deepest& out) {
  double turn = kTwoPi / kGenerators, along = 1.0 / kAlong;
  for (int k = 0; k < kHalvings; ++k, turn *= 0.5, along *= 0.5) {
    bool better = true;
    for (int moves = 0; better && moves < kMoves && !stopped(); ++moves) {
      better = false;
      for (const auto& [dphi, dshare] : {std::pair{turn, 0.0}, std::pair{-turn, 0.0},
                                         std::pair{0.0, along}, std::pair{0.0, -along}}) {
        const MetalPoint next{from.rho, from.phi + dphi, std::clamp(from.share + dshare, 0.0, 1.0)};
        const double before = out.depth;
        see(m, other, next, out);
        if (!(out.depth > before * (1.0 + 1e-9))) continue;
        from = next;
        better = true;
      }
    }
  }
}

void keep_deeper(const Deepest& one, Deepest& out) {
  if (one.depth > out.depth) out = one;
}

/// Samples the wall's generators at evenly spaced points inside the other.
void deepen(const Finished& m, const Finished& other, Deepest& out) {
  for (const double rho : walls(m)) {
    Deepest own;
    MetalPoint best{rho, 0.0, 0.0};
    for (int i = 0; i < kGenerators && !stopped(); ++i)
      for (int k = 0; k <= kAlong; ++k) {
        const MetalPoint place{rho, kTwoPi * i / kGenerators, static_cast<double>(k) / kAlong};
        const double before = own.depth;
        see(m, other, place, own);
        if (own.depth > before) best = place;
      }
    if (own.depth > 0.0) climb(m, other, best, own);
    keep_deeper(own, out);
  }
}

/// Returns where the outline of a section is nearest to a point, as Finished::line takes it.
double nearest_turn(const Finished& m, const Vector3d& point) {
  constexpr int kPlaces = 256;
  const auto at = m.section->across(point - m.start);
  double best = 0.0, least = kInfinite;
  for (int k = 0; k < kPlaces; ++k) {
    const double s = m.section->curve.girth() * k / kPlaces;
    if (const double off = (m.section->curve.at(s).point - at).norm(); off < least) {
      least = off;
      best = kTwoPi * k / kPlaces;
    }
  }
  return best;
}

/// Searches from a point that both share, at its own radius and at those of the wall: finds
/// features that are thinner than the steps between generators.
void deepen_from(const Finished& m, const Finished& other, const Vector3d& shared, Deepest& out) {
  const Vector3d from = shared - m.start;
  const double z = from.dot(m.axis);
  const Vector3d beside = m.first.frame.rows * (from - z * m.axis);
  double phi = elementary::atan2(beside.y(), beside.x()), own_rho = beside.norm();
  if (m.section) {
    phi = nearest_turn(m, shared);
    own_rho = m.outer - m.below(shared);
  }
  for (const double rho : {own_rho, m.outer, 0.5 * (m.inner + m.outer), m.inner}) {
    const auto line = m.line(phi, rho);
    const auto r = reach(m, other, line.rho, line.q);
    if (!(r.from < r.to)) continue;
    const MetalPoint place{rho, phi, std::clamp((z - r.from) / (r.to - r.from), 0.0, 1.0)};
    Deepest own;
    see(m, other, place, own);
    climb(m, other, place, own);
    keep_deeper(own, out);
  }
}

using Pair = std::pair<std::size_t, std::size_t>;  // of members, the earlier first

/// Returns the sorted pairs whose stated joint is set in, through or mitre.
std::vector<Pair> stated_apart(const NodeSpec& spec) {
  std::vector<Pair> out;
  for (const auto& one : spec.joints)
    if (one.joint.kind != JointKind::set_on) out.emplace_back(std::minmax(one.member, one.with));
  std::ranges::sort(out);
  return out;
}

/// Returns true for pairs that cannot overlap, because one cuts the other everywhere, or that
/// overlap by their stated joint.
bool settled(const Nodes& nodes, const std::vector<Pair>& stated, std::size_t a, std::size_t b) {
  for (const auto& [member, other] : {Pair{a, b}, Pair{b, a}})
    for (const auto end : {2 * member, 2 * member + 1})
      if (std::ranges::find(nodes.ends[end].cut_by, other, &CutBy::member) !=
          nodes.ends[end].cut_by.end())
        return true;
  return std::ranges::binary_search(stated, Pair{a, b});
}

AxisSegment axis_segment(const Member& m) { return {m.start, m.finish, m.reach()}; }

struct Box {
  Vector3d low, high;

  [[nodiscard]] bool misses(const Box& other) const {
    return (low.array() > other.high.array()).any() || (high.array() < other.low.array()).any();
  }
};

Box bounds_of(const Member& m) {
  return {m.start.cwiseMin(m.finish).array() - m.reach(),
          m.start.cwiseMax(m.finish).array() + m.reach()};
}

/// Calls `visit(a, b)` for the pairs of members whose axes come nearer than their radii, until it
/// returns false: along x, over the boxes that have begun and not ended. Returns false when
/// cancelled.
template <class F>
bool near_pairs(const NodeSpec& spec, std::optional<std::size_t> only, F visit) {
  const auto& m = spec.members;
  std::vector<Box> boxes;
  for (const auto& one : m) boxes.push_back(bounds_of(one));
  std::vector<std::size_t> order(m.size()), open;
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return boxes[i].low.x(); });
  for (const auto i : order) {
    std::erase_if(open, [&](std::size_t j) { return boxes[j].high.x() < boxes[i].low.x(); });
    for (const auto j : open) {
      if (stopped()) return false;
      if ((only && *only != i && *only != j) || boxes[j].misses(boxes[i])) continue;
      if (!(nearness(axis_segment(m[i]), axis_segment(m[j])) < m[i].reach() + m[j].reach()))
        continue;
      if (!visit(std::min(i, j), std::max(i, j))) return true;
    }
    open.push_back(i);
  }
  return !stopped();
}

/// Members after their ends are cut, each computed on first use.
class FinishedMembers {
 public:
  FinishedMembers(const NodeSpec& spec, const Nodes& nodes, const Beside& beside)
      : spec_(spec), nodes_(nodes), beside_(beside), made_(spec.members.size()) {}

  const Finished& operator[](std::size_t i) {
    if (!made_[i]) made_[i] = detail::finished(spec_, nodes_, i, beside_);
    return *made_[i];
  }

 private:
  const NodeSpec& spec_;
  const Nodes& nodes_;
  const Beside& beside_;
  std::vector<std::optional<Finished>> made_;
};

std::optional<Overlap> overlap(FinishedMembers& members, std::size_t a, std::size_t b) {
  const auto &one = members[a], &two = members[b];
  const auto shared = detail::shared_metal(one, two);
  if (!shared) return std::nullopt;
  Deepest deepest{std::min(depth(one, *shared), depth(two, *shared)), *shared};
  for (const auto& [m, other] : {std::pair{&one, &two}, std::pair{&two, &one}}) {
    deepen(*m, *other, deepest);
    if (deepest.depth < kThin * (one.outer + two.outer)) deepen_from(*m, *other, *shared, deepest);
  }
  return Overlap{a, b, deepest.depth, deepest.at};
}

tl::unexpected<Error> too_many(std::size_t pairs, std::size_t most, const char* what) {
  return fail({.code = ErrorCode::wrong_count,
               .member = "members",
               .got = static_cast<double>(pairs),
               .limit = static_cast<double>(most),
               .hint = std::string("pairs of members that ") + what +
                       ": give each member once, and fewer at a time"});
}

}  // namespace

tl::unexpected<Error> too_many_overlaps(std::size_t pairs) {
  return too_many(pairs, kMostOverlaps, "share metal");
}

Result<std::vector<Overlap>> overlaps(const NodeSpec& spec, const Nodes& nodes,
                                      std::optional<std::size_t> only, const Beside& beside) {
  const auto stated = stated_apart(spec);
  // Count first, so that too many pairs are rejected at once and not after all permitted pairs were
  // checked.
  std::size_t near = 0;
  if (!near_pairs(spec, only, [&](std::size_t a, std::size_t b) {
        if (!settled(nodes, stated, a, b)) ++near;
        return near <= kMostNearPairs;
      }))
    return fail({.code = ErrorCode::cancelled});
  if (near > kMostNearPairs)
    return too_many(near, kMostNearPairs, "come nearer than their radii and do not cut each other");
  std::vector<Overlap> out;
  FinishedMembers members(spec, nodes, beside);
  if (!near_pairs(spec, only, [&](std::size_t a, std::size_t b) {
        if (settled(nodes, stated, a, b)) return true;
        if (const auto one = overlap(members, a, b)) out.push_back(*one);
        return out.size() <= kMostOverlaps;
      }))
    return fail({.code = ErrorCode::cancelled});
  if (out.size() > kMostOverlaps) return too_many_overlaps(out.size());
  std::ranges::sort(out, {}, [](const Overlap& o) { return std::pair{o.a, o.b}; });
  return out;
}

std::vector<Warning> warnings_of(const NodeSpec& spec, const std::vector<Overlap>& overlaps,
                                 std::optional<std::size_t> only) {
  std::vector<Warning> out;
  for (const auto& o : overlaps) {
    const auto at = only == o.b ? o.b : o.a;
    if (only && *only != at) continue;
    out.push_back({.code = WarningCode::members_overlap,
                   .member = "members/" + std::to_string(at),
                   .detail = "it and " + detail::called(spec, at == o.a ? o.b : o.a) +
                             " share metal, up to " + brief(o.depth) + " mm deep, at " +
                             brief(o.at.x()) + ", " + brief(o.at.y()) + ", " + brief(o.at.z()) +
                             " mm"});
  }
  return out;
}

std::vector<Warning> once_a_pair(const NodeSpec& spec, const Nodes& nodes) {
  auto out = nodes.warnings;
  for (const auto& end : nodes.ends)
    for (const auto& cut : end.cut_by) {
      if (!cut.plane || cut.member > end.member) continue;
      const auto place = place_of(end.member, end.end);
      const auto of = " that of " + detail::called(spec, cut.member) + " are ";
      std::erase_if(out, [&](const Warning& w) {
        return w.code == WarningCode::mitre_steps && w.member == place &&
               w.detail.find(of) != std::string::npos;
      });
    }
  return out;
}

}  // namespace tubecut::joint
