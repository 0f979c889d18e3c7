#include "core/joint/node/in_line.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/node/corner_mitre.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/shape.hpp"

namespace tubecut::joint {

using Eigen::Vector3d;

Facing facing(const Member& a, End of_a, const Member& b, End of_b) {
  const Vector3d u = a.into(of_a).normalized(), v = b.into(of_b).normalized();
  const Vector3d w = b.at(of_b) - a.at(of_a);
  Facing out{.angle = elementary::atan2(u.cross(v).norm(), -u.dot(v))};
  const Vector3d line = (v - u).squaredNorm() > 0.0 ? (v - u).normalized() : u;
  out.apart = w.dot(line);
  out.beside = w.cross(line).norm();
  return out;
}

bool in_line(const Facing& facing, double step, double apart) {
  return facing.angle <= kInLineMost && facing.beside <= kBesideMost + step &&
         std::abs(facing.apart) <= apart;
}

namespace detail {
namespace {

constexpr double kAsNear =
    1.0 * kRadPerDeg;  // if two ends continue this one within this difference, they are equal

bool alike(const Member& a, const Member& b) {
  return a.priority == b.priority && a.half_size() == b.half_size();
}

/// Returns true if the stated joint permits that the pair is in line.
class Stated {
 public:
  explicit Stated(const NodeSpec& spec) {
    for (std::size_t i = 0; i + spec.found < spec.joints.size(); ++i) {
      const auto& one = spec.joints[i];
      kinds_.emplace(std::minmax(one.member, one.with), one.joint.kind);
    }
  }
  [[nodiscard]] bool lets(std::size_t a, std::size_t b) const {
    const auto kind = kinds_.find(std::minmax(a, b));
    return kind == kinds_.end() || kind->second == JointKind::mitre;
  }

 private:
  std::map<Applied::Pair, JointKind> kinds_;
};

/// The best continuation of an end; empty when two are equally good.
class Best {
 public:
  void see(std::size_t end, double angle, bool unlike) {
    if ((best_ && best_->end == end) || (second_ && second_->end == end)) return;
    const Seen seen{unlike, angle, end};
    if (!best_ || seen < *best_) {
      second_ = best_;
      best_ = seen;
    } else if (!second_ || seen < *second_) {
      second_ = seen;
    }
  }
  [[nodiscard]] std::optional<Mate> take() const {
    if (!best_) return std::nullopt;
    if (second_ && second_->unlike == best_->unlike && second_->angle < best_->angle + kAsNear)
      return std::nullopt;
    return Mate{best_->end, best_->angle};
  }

 private:
  struct Seen {
    bool unlike;
    double angle;
    std::size_t end;
    friend auto operator<=>(const Seen&, const Seen&) = default;
  };
  std::optional<Seen> best_, second_;
};

/// Returns the maximum distance of two ends along their line: the joining distance of members; for
/// linked ends, about their thickness.
double most_apart(const NodeSpec& spec, std::size_t a, std::size_t b) {
  if (const auto* within = std::get_if<Within>(&spec.connect))
    return std::max(within->distance, kBesideMost);
  return kBesideMost + std::max(spec.members[a].reach(), spec.members[b].reach());
}

/// Finds for each end the ends that continue it. If one of two ends is linked to the other, both
/// are.
std::vector<Best> candidates(const NodeSpec& spec, const Joined& joined) {
  const Stated stated(spec);
  const bool named = !std::holds_alternative<Within>(spec.connect);
  std::vector<Best> out(joined.size());
  for (std::size_t p = 0; p < joined.size(); ++p)
    for (const auto& touch : joined[p]) {
      const auto a = p / 2, b = touch.other;
      if (!stated.lets(a, b)) continue;
      const auto& m = spec.members[a];
      const auto& n = spec.members[b];
      for (const auto q : {2 * b, 2 * b + 1}) {
        const auto how = facing(m, end_of(p), n, end_of(q));
        if (!in_line(how, size_step(m, n), most_apart(spec, a, b))) continue;
        const bool unlike = !same_outline(m, n);
        out[p].see(q, how.angle, unlike);
        if (named) out[q].see(p, how.angle, unlike);
      }
    }
  return out;
}

std::vector<std::optional<Mate>> mates(const NodeSpec& spec, const Joined& joined) {
  std::vector<std::optional<Mate>> best;
  for (const auto& one : candidates(spec, joined)) best.push_back(one.take());
  auto out = best;
  for (std::size_t p = 0; p < out.size(); ++p)
    if (best[p] && !(best[best[p]->end] && best[best[p]->end]->end == p)) out[p].reset();
  return out;
}

/// Returns for each member the earliest one that is joined to it by mates for which `same` holds.
template <class F>
std::vector<std::size_t> earliest(const std::vector<std::optional<Mate>>& mates, F same) {
  std::vector<std::size_t> out(mates.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = i;
  const auto root = [&](std::size_t i) {
    while (out[i] != i) i = out[i];
    return i;
  };
  for (std::size_t p = 0; p < mates.size(); ++p) {
    if (!mates[p] || !same(p / 2, mates[p]->end / 2)) continue;
    const auto a = root(p / 2), b = root(mates[p]->end / 2);
    out[std::max(a, b)] = std::min(a, b);
  }
  for (auto& one : out) one = root(one);
  return out;
}

/// Returns the end of the touched member that is nearer to the contact.
std::size_t nearer_end(const NodeSpec& spec, const Touch& touch) {
  const auto& other = spec.members[touch.other];
  const Vector3d& at = spec.members[touch.end / 2].at(end_of(touch.end));
  return end_index(touch.other, (at - other.start).norm() <= (at - other.finish).norm()
                                    ? End::start
                                    : End::finish);
}

/// Returns true if a chord that carries the branch, although it is narrower, holds the work point
/// of its end inside: the chord has no end there that the branch could cut.
bool stops_end(const Member& chord, const Member& branch, End end) {
  constexpr double kInside =
      0.03;  // of the chord's reach: drawn at the surface, it only touches it
  return chord.priority == branch.priority && carries(chord, branch) &&
         distance_from(chord, branch.at(end)) < -kInside * chord.reach();
}

/// Returns pairs of members of which the first continues where the second ends, and the second does
/// not continue there too.
std::set<Applied::Pair> going_on(const NodeSpec& spec, const Joined& joined, const Lines& lines,
                                 double within) {
  std::set<Applied::Pair> out;
  for (const auto& touches : joined)
    for (const auto& touch : touches) {
      const auto b = touch.end / 2, a = touch.other;
      const auto& chord = spec.members[a];
      const auto& branch = spec.members[b];
      if (lines.line[a] == lines.line[b]) continue;
      const bool passes = runs_past(chord, branch, end_of(touch.end), touch.near.inside, within);
      const bool continues =
          may_cut(chord, branch) && lines.mates[nearer_end(spec, touch)] && !lines.mates[touch.end];
      if (passes || continues) out.insert({a, b});
    }
  for (auto it = out.begin(); it != out.end();)
    if (out.contains({it->second, it->first})) {
      out.erase({it->second, it->first});
      it = out.erase(it);
    } else {
      ++it;
    }
  return out;
}

}  // namespace

bool may_cut(const Member& chord, const Member& branch) {
  return chord.priority == branch.priority &&
         (chord.half_size() >= branch.half_size() || covers(chord, branch));
}

bool runs_past(const Member& chord, const Member& branch, End end, double inside, double within) {
  if (!may_cut(chord, branch))
    return stops_end(chord, branch, end) && goes_on(chord, branch, inside);
  return goes_on(chord, branch, inside) ||
         (alike(chord, branch) && inside > within + chord.reach());
}

bool Lines::goes_before(const NodeSpec& spec, std::size_t a, std::size_t b) const {
  if (first.contains({a, b})) return true;
  if (first.contains({b, a})) return false;
  if (alike(spec.members[a], spec.members[b]) && rank[a] != rank[b]) return rank[a] < rank[b];
  return detail::goes_before(spec, a, b);
}

bool Lines::listed_before(const NodeSpec& spec, std::size_t a, std::size_t b) const {
  if (alike(spec.members[a], spec.members[b]) && rank[a] != rank[b]) return rank[a] < rank[b];
  return detail::goes_before(spec, a, b);
}

Lines lines_of(const NodeSpec& spec, const Joined& joined) {
  Lines out{.mates = mates(spec, joined), .line = {}, .rank = {}, .first = {}};
  out.line = earliest(out.mates, [](std::size_t, std::size_t) { return true; });
  out.rank.resize(out.line.size());
  for (std::size_t i = 0; i < out.rank.size(); ++i) out.rank[i] = i;
  const auto* within = std::get_if<Within>(&spec.connect);
  out.first = going_on(spec, joined, out, within ? within->distance : 0.0);
  if (within == nullptr) return out;
  out.first.merge(posts_on_corners(spec, joined, out));
  out.rank = earliest(out.mates, [&](std::size_t a, std::size_t b) {
    return alike(spec.members[a], spec.members[b]);
  });
  return out;
}

namespace {

/// Finds the members between the two ends: they cut both, continue there, and cross them.
std::vector<std::size_t> between(const NodeSpec& spec, const Joined& joined, const Lines& lines,
                                 std::size_t p, std::size_t q) {
  std::vector<std::size_t> out;
  for (const auto& touch : joined[p]) {
    const auto c = touch.other;
    if (std::ranges::find(joined[q], c, &Touch::other) == joined[q].end()) continue;
    if (!lines.goes_before(spec, c, p / 2) || !lines.goes_before(spec, c, q / 2)) continue;
    const double sine = std::min(sine_between(spec.members[c], spec.members[p / 2]),
                                 sine_between(spec.members[c], spec.members[q / 2]));
    const bool goes_on = touch.near.inside > 0.5 * spec.members[c].reach() ||
                         lines.mates[nearer_end(spec, touch)].has_value();
    if (goes_on && sine > elementary::sin(kInLineMost)) out.push_back(c);
  }
  return out;
}

/// Returns true if every line of the end's bore meets one of these.
bool stops(const NodeSpec& spec, std::size_t end, const std::vector<std::size_t>& members) {
  const auto& m = spec.members[end / 2];
  const auto at = end_of(end);
  const Vector3d x = m.section ? height_of(m) : m.into(at).unitOrthogonal();
  const auto frame = member_frame(m.at(at), m.at(at) + m.into(at), x);
  if (!frame) return false;
  const auto stopped_by = [&](bool wide) {
    std::vector<Cutter> cutters;
    std::vector<PreparedCutter> prepared;
    for (const auto c : members) {
      const auto& chord = spec.members[c];
      const auto placed = cutter_of(wide ? as_met(chord, m) : chord, *frame);
      if (!placed) continue;
      if (const auto one = prepare(*placed)) {
        cutters.push_back(*placed);
        prepared.push_back(*one);
      }
    }
    if (cutters.empty()) return false;
    return m.section ? closed(cutters, m.section->bore())
                     : closed(prepared, m.outer_radius - m.wall);
  };
  return stopped_by(false) || stopped_by(true);
}

}  // namespace

bool separated(const NodeSpec& spec, const Joined& joined, const Lines& lines, std::size_t p,
               std::size_t q) {
  const auto members = between(spec, joined, lines, p, q);
  return !members.empty() && stops(spec, p, members) && stops(spec, q, members);
}

Short short_of(const NodeSpec& spec, const Lines& lines, std::size_t end, const Vector3d& at) {
  constexpr double kLower =
      0.5;  // mm: a tube that continues with a smaller step counts as the same tube
  const auto beyond = [&](std::size_t e) {
    const auto& m = spec.members[e / 2];
    return -(at - m.at(end_of(e))).dot(m.into(end_of(e)).normalized());
  };
  Short out{.by = beyond(end), .instead = {}};
  const auto& first = spec.members[end / 2];
  bool square = true;
  for (std::size_t i = 0; i < lines.mates.size();
       ++i) {  // along the line, at most its whole length
    const auto& mate = lines.mates[end];
    if (!mate) return out;
    square = square && mate->angle <= kButtMost;
    const auto& n = spec.members[mate->end / 2];
    const double past = beyond(mate->end ^ 1U);
    if (past > 0.0) {
      end = mate->end ^ 1U;
      out.by = past;
      continue;
    }
    const bool same = square && same_outline(first, n);
    double lower = 0.0;
    if (n.section) {
      lower = distance_from(n, at);
    } else {
      const Vector3d along = n.into(end_of(mate->end)).normalized();
      lower = (at - n.start).cross(along).norm() - n.outer_radius;
    }
    if (same || lower <= kLower) return {};
    return {.by = lower, .instead = mate->end / 2};
  }
  return out;
}

}  // namespace detail
}  // namespace tubecut::joint
