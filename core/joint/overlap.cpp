#include "core/joint/overlap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "core/base/elementary.hpp"
#include "core/joint/node_parts.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kLeast = 0.01;      // mm: what the proofs of two cuts may share anyway
constexpr int kGenerators = 48;      // of a wall, looked at for how near it comes
constexpr int kAlong = 12;           // points of a generator inside the other member
constexpr double kInfinite = 1e300;  // mm
constexpr double kWorth = 0.01;      // of the radius: a nearer least value may lie between samples
constexpr int kHalvings = 14;        // of the steps of the search for the deepest point
constexpr int kMoves = 24;           // with one step

/// One cut end: its frame, and the seats that cut it.
struct Cut {
  MemberFrame frame;
  std::vector<PreparedCutter> seats;

  /// z into the member where the generator on the side `q` leaves the seats; the work point where
  /// nothing cuts it.
  [[nodiscard]] double top(double rho, const Vector3d& q) const {
    const Generator line{rho, q.dot(frame.rows.row(0)), q.dot(frame.rows.row(1))};
    const auto hit = highest(seats, line);
    return hit ? hit->z : 0.0;
  }
};

/// A member as it is once cut, its axis from the start.
struct Finished {
  Vector3d start, axis;
  double length, inner, outer;
  Cut first, last;

  struct Span {
    double from, to;
  };
  [[nodiscard]] Span span(double rho, const Vector3d& q) const {
    return {first.top(rho, q), length - last.top(rho, q)};
  }
  /// A side of the member: a unit vector across its axis.
  [[nodiscard]] Vector3d side(double phi) const {
    const auto at = elementary::sincos(phi);
    return at.cos * first.frame.rows.row(0).transpose() +
           at.sin * first.frame.rows.row(1).transpose();
  }
  [[nodiscard]] Vector3d point(double rho, const Vector3d& q, double z) const {
    return start + z * axis + rho * q;
  }
};

Cut cut_of(const MemberEnd& end) {
  return {.frame = end.frame, .seats = detail::prepared_seats(end)};
}

Finished finished(const NodeSpec& spec, const Nodes& nodes, std::size_t i) {
  const auto& m = spec.members[i];
  const Vector3d along = m.finish - m.start;
  return {.start = m.start,
          .axis = along.normalized(),
          .length = along.norm(),
          .inner = m.outer_radius - m.wall,
          .outer = m.outer_radius,
          .first = cut_of(nodes.ends[2 * i]),
          .last = cut_of(nodes.ends[2 * i + 1])};
}

/// How deep a point lies inside the finished member, and how deep in its metal.
struct Depth {
  double solid = -kInfinite, metal = -kInfinite;
};
Depth depth(const Finished& m, const Vector3d& p) {
  const Vector3d from = p - m.start;
  const double z = from.dot(m.axis);
  const Vector3d beside = from - z * m.axis;
  const double rho = beside.norm();
  const Vector3d q = rho > 0.0 ? Vector3d(beside / rho) : m.side(0.0);
  const auto span = m.span(std::clamp(rho, m.inner, m.outer), q);
  const double solid = std::min({m.outer - rho, z - span.from, span.to - z});
  return {solid, std::min(solid, rho - m.inner)};
}

/// The stretch of a generator of `m` inside the other's outer cylinder, prolonged, and between its
/// own cuts; and how far it passes from that cylinder at the nearest.
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

/// Does any of the wall come into the other's outer cylinder, prolonged without end?
bool enters(const Finished& m, const Finished& other, const std::stop_token& stop) {
  for (const double rho : walls(m)) {
    if (stop.stop_requested()) return false;
    const auto near = [&](double phi) { return -reach(m, other, rho, m.side(phi)).clearance; };
    std::array<double, kGenerators> sampled{};
    for (std::size_t k = 0; k < kGenerators; ++k)
      if (sampled[k] = near(kTwoPi * static_cast<double>(k) / kGenerators); sampled[k] > kLeast)
        return true;
    for (std::size_t k = 0; k < kGenerators; ++k) {
      const double here = sampled[k];
      const bool best = here >= sampled[(k + kGenerators - 1) % kGenerators] &&
                        here >= sampled[(k + 1) % kGenerators];
      if (!best || here < -kWorth * (m.outer + other.outer)) continue;
      const double phi = kTwoPi * static_cast<double>(k) / kGenerators, step = kTwoPi / kGenerators;
      if (math::golden_maximum(near, phi - step, phi + step).value > kLeast) return true;
    }
  }
  return false;
}

/// The deepest of one member's metal in the other, and the deepest in both metals.
struct Deepest {
  double solid = 0.0, metal = 0.0;
  Vector3d at = Vector3d::Zero();
};

/// A place in a member's wall: generator, and the share of its stretch inside the other.
struct Place {
  double rho, phi, share;
};

void see(const Finished& m, const Finished& other, const Place& place, Deepest& out) {
  const Vector3d q = m.side(place.phi);
  const auto r = reach(m, other, place.rho, q);
  if (!(r.clearance < 0.0 && r.from < r.to)) return;
  const Vector3d p = m.point(place.rho, q, r.from + place.share * (r.to - r.from));
  const auto d = depth(other, p);
  out.metal = std::max(out.metal, d.metal);
  if (d.solid <= out.solid) return;
  out.solid = d.solid;
  out.at = p;
}

/// From the deepest of the sampled places on, by steps that halve.
void climb(const Finished& m, const Finished& other, Place from, const std::stop_token& stop,
           Deepest& out) {
  double turn = kTwoPi / kGenerators, along = 1.0 / kAlong;
  for (int k = 0; k < kHalvings; ++k, turn *= 0.5, along *= 0.5) {
    bool better = true;
    for (int moves = 0; better && moves < kMoves && !stop.stop_requested(); ++moves) {
      better = false;
      for (const auto& [dphi, dshare] : {std::pair{turn, 0.0}, std::pair{-turn, 0.0},
                                         std::pair{0.0, along}, std::pair{0.0, -along}}) {
        const Place next{from.rho, from.phi + dphi, std::clamp(from.share + dshare, 0.0, 1.0)};
        const double before = out.solid;
        see(m, other, next, out);
        if (!(out.solid > before * (1.0 + 1e-9))) continue;
        from = next;
        better = true;
      }
    }
  }
}

void look(const Finished& m, const Finished& other, const std::stop_token& stop, Deepest& out) {
  for (const double rho : walls(m)) {
    Deepest own;
    Place best{rho, 0.0, 0.0};
    for (int i = 0; i < kGenerators && !stop.stop_requested(); ++i)
      for (int k = 0; k <= kAlong; ++k) {
        const Place place{rho, kTwoPi * i / kGenerators, static_cast<double>(k) / kAlong};
        const double before = own.solid;
        see(m, other, place, own);
        if (own.solid > before) best = place;
      }
    if (own.solid > 0.0) climb(m, other, best, stop, own);
    out.metal = std::max(out.metal, own.metal);
    if (own.solid <= out.solid) continue;
    out.solid = own.solid;
    out.at = own.at;
  }
}

using Pair = std::pair<std::size_t, std::size_t>;  // of members, the earlier first

/// Pairs that by what is stated are set in, pass through or are mitred; sorted.
std::vector<Pair> stated_apart(const NodeSpec& spec) {
  std::vector<Pair> out;
  for (const auto& one : spec.joints)
    if (one.joint.kind != JointKind::set_on) out.emplace_back(std::minmax(one.member, one.with));
  std::ranges::sort(out);
  return out;
}

/// Pairs that cannot share metal, for the one is cut by the other wherever it meets that; or that
/// share it by what is stated.
bool settled(const Nodes& nodes, const std::vector<Pair>& stated, std::size_t a, std::size_t b) {
  for (const auto& [member, other] : {Pair{a, b}, Pair{b, a}})
    for (const auto end : {2 * member, 2 * member + 1})
      if (std::ranges::find(nodes.ends[end].cut_by, other, &CutBy::member) !=
          nodes.ends[end].cut_by.end())
        return true;
  return std::ranges::binary_search(stated, Pair{a, b});
}

Stretch stretch(const Member& m) { return {m.start, m.finish, m.outer_radius}; }

struct Box {
  Vector3d low, high;

  [[nodiscard]] bool misses(const Box& other) const {
    return (low.array() > other.high.array()).any() || (high.array() < other.low.array()).any();
  }
};

Box box_of(const Member& m) {
  return {m.start.cwiseMin(m.finish).array() - m.outer_radius,
          m.start.cwiseMax(m.finish).array() + m.outer_radius};
}

/// Calls `visit(a, b)` for the pairs of members whose axes come nearer than their radii, until it
/// says false: along x, those whose boxes have begun and not ended. False where it was stopped.
template <class F>
bool near_pairs(const NodeSpec& spec, std::optional<std::size_t> only, const std::stop_token& stop,
                F visit) {
  const auto& m = spec.members;
  std::vector<Box> boxes;
  for (const auto& one : m) boxes.push_back(box_of(one));
  std::vector<std::size_t> order(m.size()), open;
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return boxes[i].low.x(); });
  for (const auto i : order) {
    std::erase_if(open, [&](std::size_t j) { return boxes[j].high.x() < boxes[i].low.x(); });
    for (const auto j : open) {
      if (stop.stop_requested()) return false;
      if ((only && *only != i && *only != j) || boxes[j].misses(boxes[i])) continue;
      if (!(nearness(stretch(m[i]), stretch(m[j])) < m[i].outer_radius + m[j].outer_radius))
        continue;
      if (!visit(std::min(i, j), std::max(i, j))) return true;
    }
    open.push_back(i);
  }
  return !stop.stop_requested();
}

std::optional<Overlap> overlap(const NodeSpec& spec, const Nodes& nodes, std::size_t a,
                               std::size_t b, const std::stop_token& stop) {
  const auto one = finished(spec, nodes, a), two = finished(spec, nodes, b);
  if (!enters(one, two, stop) || !enters(two, one, stop)) return std::nullopt;
  Deepest deepest;
  look(one, two, stop, deepest);
  look(two, one, stop, deepest);
  if (!(deepest.solid > kLeast && deepest.metal > kLeast)) return std::nullopt;
  return Overlap{a, b, deepest.solid, deepest.at};
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

Result<std::vector<Overlap>> overlaps(const NodeSpec& spec, const Nodes& nodes,
                                      std::optional<std::size_t> only,
                                      const std::stop_token& stop) {
  const auto stated = stated_apart(spec);
  // Counted first: too many are refused in a moment, not after all that may be looked at were.
  std::size_t near = 0;
  if (!near_pairs(spec, only, stop, [&](std::size_t a, std::size_t b) {
        if (!settled(nodes, stated, a, b)) ++near;
        return near <= kMostNearPairs;
      }))
    return fail({.code = ErrorCode::cancelled});
  if (near > kMostNearPairs)
    return too_many(near, kMostNearPairs, "come nearer than their radii and do not cut each other");
  std::vector<Overlap> out;
  if (!near_pairs(spec, only, stop, [&](std::size_t a, std::size_t b) {
        if (settled(nodes, stated, a, b)) return true;
        if (const auto one = overlap(spec, nodes, a, b, stop)) out.push_back(*one);
        return out.size() <= kMostOverlaps;
      }))
    return fail({.code = ErrorCode::cancelled});
  if (out.size() > kMostOverlaps) return too_many(out.size(), kMostOverlaps, "share metal");
  std::ranges::sort(out, {}, [](const Overlap& o) { return std::pair{o.a, o.b}; });
  return out;
}

std::vector<Warning> warnings_of(const NodeSpec& spec, const std::vector<Overlap>& overlaps,
                                 std::optional<std::size_t> only) {
  std::vector<Warning> out;
  for (const auto& o : overlaps)
    for (const auto& [member, other] : {std::pair{o.a, o.b}, std::pair{o.b, o.a}})
      if (!only || *only == member)
        out.push_back({.code = WarningCode::members_overlap,
                       .member = "members/" + std::to_string(member),
                       .detail = "it and " + detail::called(spec, other) + " share metal, up to " +
                                 brief(o.depth) + " mm deep, at " + brief(o.at.x()) + ", " +
                                 brief(o.at.y()) + ", " + brief(o.at.z()) + " mm"});
  return out;
}

}  // namespace tubecut::joint
