#include "core/joint/node/corner_mitre.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "core/joint/node/shape.hpp"
#include "core/joint/node/shared_corner.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSteeper = 1e-3;  // of the rise of two planes
constexpr double kOutside = 0.05;  // mm: of an edge that its chord does not hide

/// Returns true if the members of three ends leave it square to each other.
bool is_box_corner(const NodeSpec& spec, const std::vector<std::size_t>& ends) {
  constexpr double kSquare = 1e-3;  // cosine
  const auto into = [&](std::size_t k) {
    return Vector3d(spec.members[ends[k] / 2].into(end_of(ends[k])).normalized());
  };
  if (ends.size() != 3) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(into(k).dot(into((k + 1) % 3))) > kSquare) return false;
  return true;
}

/// Returns which of three ends leaves the corner between the two others, in their plane.
std::optional<std::size_t> middle_of(const NodeSpec& spec, const std::vector<std::size_t>& ends) {
  constexpr double kFlat = 1e-3;  // sine
  if (ends.size() != 3) return std::nullopt;
  const auto into = [&](std::size_t k) {
    const auto at = ends[k % 3];
    return Vector3d(spec.members[at / 2].into(end_of(at)).normalized());
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d before = into(k + 1).cross(into(k)), after = into(k).cross(into(k + 2));
    const Vector3d whole = into(k + 1).cross(into(k + 2));
    if (before.dot(after) > 0.0 && before.dot(whole) > 0.0 && before.norm() > kFlat &&
        after.norm() > kFlat && std::abs(into(k).dot(whole)) < kFlat)
      return k;
  }
  return std::nullopt;
}

/// Returns which of the planes of a box's corner lies flattest in the world. If two of three lie
/// equally flat, as at the apex of an A-frame with a ridge, that is the third, because the choice
/// between them would depend on the order of the list; the first if all do.
std::size_t flattest(const std::vector<double>& rises) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < rises.size(); ++k)
    if (rises[k] > rises[best] + kSteeper) best = k;
  if (rises.size() != 3) return best;
  std::vector<std::size_t> lower;
  for (std::size_t k = 0; k < 3; ++k)
    if (rises[k] < rises[best] - kSteeper) lower.push_back(k);
  return lower.size() == 1 ? lower.front() : best;
}

/// Two ends in space, and where their axes meet.
struct Corner {
  const Member& a;
  const Member& b;
  Vector3d u, v;          // into them, unit
  Vector3d point;         // of the plane between them
  double off = 0.0;       // of the axes from that point
  double furthest = 0.0;  // of the ends from that point
};
Corner corner_of(const NodeSpec& spec, const EndPair& pair) {
  const auto& a = spec.members[pair.first / 2];
  const auto& b = spec.members[pair.second / 2];
  const auto p = end_of(pair.first), q = end_of(pair.second);
  Corner out{a, b, a.into(p).normalized(), b.into(q).normalized(), {}};
  const Vector3d w = b.at(q) - a.at(p);
  const auto [s, t] = meeting(spec, pair.first, pair.second);
  out.point = a.at(p) + 0.5 * (w + t * out.v + s * out.u);
  out.off = 0.5 * (w + t * out.v - s * out.u).norm();
  out.furthest = std::max(std::abs(s), std::abs(t));
  return out;
}

class Search {
 public:
  Search(const Joints& joints, const std::vector<MemberEnd>& ends)
      : joints_(joints), ends_(ends), corners_(shared_corners(joints)) {}

  /// Each kind only if there is none of the kinds before, because a third member may end on two
  /// that are mitred.
  [[nodiscard]] std::set<EndPair> run() const {
    if (auto out = at_chords(); !out.empty()) return out;
    std::set<EndPair> others;
    std::map<std::size_t, std::vector<std::size_t>> corners;  // of an end, those it alone cuts
    for (std::size_t end = 0; end < ends_.size(); ++end) {
      const auto pairs = open_corners(end);
      others.insert(pairs.begin(), pairs.end());
      if (pairs.size() != 1) continue;
      const auto [p, q] = *pairs.begin();
      corners[p == end ? q : p].push_back(end);
    }
    std::set<EndPair> out;
    for (auto& [end, ends] : corners) {
      ends.push_back(end);
      std::ranges::sort(ends);
      out.merge(mitres_of(ends));
    }
    return out.empty() ? others : out;
  }

 private:
  [[nodiscard]] std::set<EndPair> at_chords() const {
    std::map<std::size_t, std::vector<std::size_t>> at;  // the ends that a chord cuts
    for (std::size_t i = 0; i < ends_.size(); ++i)
      for (const auto& cut : ends_[i].cut_by)
        if (!cut.plane && !is_open(cut)) at[cut.member].push_back(i);
    std::set<EndPair> out;
    for (const auto& [chord, ends] : at)
      for (std::size_t k = 0; k < ends.size(); ++k)
        for (std::size_t l = k + 1; l < ends.size(); ++l)
          if (const EndPair pair{ends[k], ends[l]}; near(pair) && meet(chord, pair))
            out.insert(pair);
    return out;
  }

  [[nodiscard]] bool near(const EndPair& pair) const {
    const auto& a = joints_.spec.members[pair.first / 2];
    const auto& b = joints_.spec.members[pair.second / 2];
    const Vector3d w = b.at(end_of(pair.second)) - a.at(end_of(pair.first));
    return &a != &b && w.norm() <= far_end(a, b);
  }

  /// Returns true if the two ends can end at a plane between them: no joint of the two is stated,
  /// and the edges along that plane are one.
  [[nodiscard]] bool may_mitre(const EndPair& pair) const {
    const auto& [spec, applied, lines, joined] = joints_;
    const auto a = pair.first / 2, b = pair.second / 2;
    if (applied.joints.contains(std::minmax(a, b)) || lines.line[a] == lines.line[b] ||
        sine_between(spec.members[a], spec.members[b]) < kNearParallel)
      return false;
    const auto at = corner_of(spec, pair);
    return at.off <= kCornerStep && at.furthest <= far_end(at.a, at.b) &&
           edge_step(at.a, at.b, at.point, (at.u - at.v).normalized()) <= kCornerStep;
  }

  /// Returns true if the two ends at one chord can end at a plane between them, and have to.
  [[nodiscard]] bool meet(std::size_t chord, const EndPair& pair) const {
    const auto a = pair.first / 2, b = pair.second / 2;
    if (!is_set_on(joints_.applied, a, chord) || !is_set_on(joints_.applied, b, chord) ||
        std::ranges::any_of(corners_[pair.first],
                            [&](const auto& c) { return c.chord == chord && c.other == b; }) ||
        !may_mitre(pair))
      return false;
    const auto* cut = cut_of(pair.first, b);
    if (cut == nullptr) cut = cut_of(pair.second, a);
    if (cut != nullptr) return is_open(*cut);
    const auto at = corner_of(joints_.spec, pair);
    return edge_outside(at.a, at.a.into(end_of(pair.first)), at.point, (at.u - at.v).normalized(),
                        at.u + at.v, chords_of(pair)) > kOutside;
  }

  /// Returns the pairs of the ends at one corner that are mitred: of the corner of a box the one
  /// whose plane lies flattest in the world, because posts end on frames; else all, if all may be,
  /// or the first that may.
  [[nodiscard]] std::set<EndPair> mitres_of(const std::vector<std::size_t>& ends) const {
    std::vector<EndPair> all;
    bool each = true;
    for (std::size_t k = 0; k < ends.size(); ++k)
      for (std::size_t l = k + 1; l < ends.size(); ++l)
        if (const EndPair pair{ends[k], ends[l]}; may_mitre(pair))
          all.push_back(pair);
        else
          each = false;
    if (is_box_corner(joints_.spec, ends)) {
      const auto rise = [&](const EndPair& pair) {
        const auto at = corner_of(joints_.spec, pair);
        return std::abs(at.u.cross(at.v).normalized().z());
      };
      std::vector<double> rises;
      for (const auto& pair : all) rises.push_back(rise(pair));
      return {all[flattest(rises)]};
    }
    if (each) return {all.begin(), all.end()};
    return {all.front()};
  }

  /// Returns the pairs of an end that only members cut which end there too, cut by none, if it is
  /// open to one of them.
  [[nodiscard]] std::set<EndPair> open_corners(std::size_t end) const {
    std::set<EndPair> out;
    if (std::ranges::none_of(ends_[end].cut_by, is_open)) return out;
    for (const auto& cut : ends_[end].cut_by) {
      if (cut.plane) continue;
      const auto pair = open_corner(end, cut);
      if (!pair) return {};
      out.insert(*pair);
    }
    return out;
  }
  [[nodiscard]] std::optional<EndPair> open_corner(std::size_t end, const CutBy& cut) const {
    const auto& spec = joints_.spec;
    const auto& from = spec.members[end / 2].at(end_of(end));
    const auto& m = spec.members[cut.member];
    const auto nearer = end_index(
        cut.member, (m.start - from).norm() <= (m.finish - from).norm() ? End::start : End::finish);
    const EndPair pair = std::minmax(end, nearer);
    const bool is_cut = !std::ranges::all_of(
        ends_[nearer].cut_by, [](const CutBy& one) { return one.plane.has_value(); });
    if (is_cut || joints_.lines.mates[nearer] || !may_mitre(pair)) return std::nullopt;
    const auto at = corner_of(spec, pair);
    if (at.furthest > std::min(at.a.half_size(), at.b.half_size()) + kCornerStep)
      return std::nullopt;
    return pair;
  }

  /// Returns true if the end would be cut where the other member's metal has ended.
  static bool is_open(const CutBy& cut) { return !cut.plane && cut.ghost && !cut.instead; }

  /// Returns the tube of a member that cuts this end; nullptr if it does not.
  [[nodiscard]] const CutBy* cut_of(std::size_t end, std::size_t member) const {
    for (const auto& cut : ends_[end].cut_by)
      if (cut.member == member && !cut.plane) return &cut;
    return nullptr;
  }
  [[nodiscard]] std::vector<const Member*> chords_of(const EndPair& pair) const {
    std::vector<const Member*> out;
    for (const auto& cut : ends_[pair.first].cut_by)
      if (cut_of(pair.second, cut.member) != nullptr)
        out.push_back(&joints_.spec.members[cut.member]);
    return out;
  }

  static constexpr double kCornerStep = 0.5;  // mm: as of found members in line

  const Joints& joints_;
  const std::vector<MemberEnd>& ends_;
  SharedCorners corners_;
};

}  // namespace

std::set<EndPair> corner_mitres(const Joints& joints, const std::vector<MemberEnd>& ends) {
  if (!std::holds_alternative<Within>(joints.spec.connect)) return {};
  return Search(joints, ends).run();
}

namespace {

/// Returns the ends that meet at this one, itself included; empty if it is not the first of them.
std::vector<std::size_t> meeting_at(const NodeSpec& spec, const Joined& joined, const Lines& lines,
                                    std::size_t end, double within) {
  const auto& own = spec.members[end / 2];
  std::vector<std::size_t> out{end};
  for (const auto& touch : joined[end])
    for (const auto other : {2 * touch.other, 2 * touch.other + 1}) {
      const auto& m = spec.members[touch.other];
      if ((m.at(end_of(other)) - own.at(end_of(end))).norm() > within) continue;
      if (other < end || lines.mates[other] || m.priority != own.priority ||
          m.half_size() != own.half_size())
        return {};
      out.push_back(other);
    }
  return lines.mates[end] ? std::vector<std::size_t>() : out;
}

/// Returns which of the ends of a box's corner stands on the two others: their plane is flattest.
std::size_t flattest_post(const NodeSpec& spec, const std::vector<std::size_t>& ends) {
  const auto rise = [&](std::size_t k) {  // of the plane of the two others
    const auto into = [&](std::size_t i) {
      const auto at = ends[(k + i) % 3];
      return Vector3d(spec.members[at / 2].into(end_of(at)).normalized());
    };
    return std::abs(into(1).cross(into(2)).normalized().z());
  };
  // From the last, which the two earlier ones cut if all are alike.
  return 2 - flattest({rise(2), rise(1), rise(0)});
}

}  // namespace

std::set<Applied::Pair> posts_on_corners(const NodeSpec& spec, const Joined& joined,
                                         const Lines& lines) {
  std::set<Applied::Pair> out;
  const auto* within = std::get_if<Within>(&spec.connect);
  if (within == nullptr) return out;
  for (std::size_t end = 0; end < joined.size(); ++end) {
    const auto ends = meeting_at(spec, joined, lines, end, std::max(within->distance, kBesideMost));
    auto post = middle_of(spec, ends);
    if (!post && is_box_corner(spec, ends)) post = flattest_post(spec, ends);
    if (!post) continue;
    for (const auto at : ends)
      if (at != ends[*post] && !lines.first.contains({ends[*post] / 2, at / 2}))
        out.insert({at / 2, ends[*post] / 2});
  }
  return out;
}

}  // namespace tubecut::joint::detail
