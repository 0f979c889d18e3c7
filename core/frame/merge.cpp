#include "core/frame/merge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/try.hpp"
#include "core/frame/frame_parts.hpp"
#include "core/joint/node/in_line.hpp"

namespace tubecut::frame {
namespace {

using Eigen::Vector3d;
using joint::end_index;
using joint::end_of;

using Mates = std::vector<std::optional<std::size_t>>;

bool alike(const joint::Member& a, const joint::Member& b) {
  return a.outer_radius == b.outer_radius && a.wall == b.wall && a.priority == b.priority &&
         a.up == b.up && a.section == b.section;
}

/// Finds for each end the end that it may be merged with.
Result<Mates> mates(const FrameSpec& spec, const MergeSpec& besides) {
  joint::NodeSpec node{.members = spec.members,
                       .connect = joint::Within{spec.within.value_or(joint::kBesideMost)}};
  std::set<std::pair<std::size_t, std::size_t>> two;
  std::set<std::size_t> kept;
  for (const auto& [member, end] : besides.kept) kept.insert(end_index(member, end));
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    const auto& one = spec.joints[i];
    if (one.plate && one.how.kind == How::Kind::through) continue;
    if (!one.of_members()) {
      TRY(const auto end, detail::end_at(spec, i));
      kept.insert(end_index(one.member, end));
      continue;
    }
    // A bar that passes through another was split there, so the other does not end its pieces.
    if (one.how.kind == How::Kind::through)
      node.joints.push_back({one.member, one.with, {.kind = joint::JointKind::through}, {}});
    if (one.how.kind != How::Kind::butt || one.how.gap > 0.0)
      two.insert(std::minmax(one.member, one.with));
  }
  TRY(auto out, joint::continued(node));
  for (std::size_t p = 0; p < out.size(); ++p) {
    if (!out[p] || *out[p] < p) continue;
    const auto q = *out[p];
    const auto& a = spec.members[p / 2];
    const auto& b = spec.members[q / 2];
    const auto how = joint::facing(a, end_of(p), b, end_of(q));
    const bool one = alike(a, b) && how.angle <= joint::kButtMost &&
                     std::abs(how.apart) <= joint::kBesideMost && !kept.contains(p) &&
                     !kept.contains(q) && !two.contains(std::minmax(p / 2, q / 2));
    if (one) continue;
    out[p].reset();
    out[q].reset();
  }
  return out;
}

/// Pieces in sequence, each by the end that comes first.
using Run = std::vector<std::size_t>;

/// Follows the line from this end through its member and on; stops where a ring closes.
Run run_from(const Mates& mates, std::size_t first) {
  Run out{first};
  for (auto next = mates[first ^ 1U]; next && *next != first; next = mates[*next ^ 1U])
    out.push_back(*next);
  return out;
}

/// Assigns every member to one run. A ring begins at its earliest member.
std::vector<Run> runs(const Mates& mates) {
  std::vector<Run> out;
  std::vector<bool> seen(mates.size() / 2, false);
  const auto take = [&](std::size_t first) {
    out.push_back(run_from(mates, first));
    for (const auto end : out.back()) seen[end / 2] = true;
  };
  for (std::size_t p = 0; p < mates.size(); ++p)
    if (!seen[p / 2] && !mates[p]) take(p);
  for (std::size_t p = 0; p < mates.size(); ++p)
    if (!seen[p / 2]) take(p);
  return out;
}

const Vector3d& point_of(const FrameSpec& spec, std::size_t end) {
  return spec.members[end / 2].at(end_of(end));
}

/// Returns the largest distance of the ends of pieces `from` to `to` (inclusive) to the line from
/// the first to the last.
double off_line(const FrameSpec& spec, const Run& run, std::size_t from, std::size_t to) {
  const Vector3d& start = point_of(spec, run[from]);
  const Vector3d along = (point_of(spec, run[to] ^ 1U) - start).normalized();
  double out = 0.0;
  for (auto i = from; i <= to; ++i)
    for (const auto end : {run[i], run[i] ^ 1U})
      out = std::max(out, (point_of(spec, end) - start).cross(along).norm());
  return out;
}

/// Splits the run into the fewest parts that keep all ends near their axes; each part is as long as
/// possible, from the first on.
std::vector<Run> straight(const FrameSpec& spec, const Run& run) {
  std::vector<Run> out;
  for (std::size_t from = 0; from < run.size();) {
    auto to = from;
    while (to + 1 < run.size() && off_line(spec, run, from, to + 1) <= joint::kBesideMost) ++to;
    out.emplace_back(run.begin() + static_cast<std::ptrdiff_t>(from),
                     run.begin() + static_cast<std::ptrdiff_t>(to) + 1);
    from = to + 1;
  }
  return out;
}

/// Gives the run the direction of its earliest piece.
Run as_earliest(Run run) {
  const auto first = *std::ranges::min_element(run);
  if (end_of(first) == joint::End::start) return run;
  std::ranges::reverse(run);
  for (auto& end : run) end ^= 1U;
  return run;
}

void add_member(const FrameSpec& spec, const Run& run, Merged& out) {
  const auto earliest = *std::ranges::min_element(run) / 2;
  auto member = spec.members[earliest];
  member.start = point_of(spec, run.front());
  member.finish = point_of(spec, run.back() ^ 1U);
  std::vector<std::size_t> pieces;
  for (const auto end : run) {
    out.of[end / 2] = {out.spec.members.size(), end_of(end) == joint::End::finish};
    pieces.push_back(end / 2);
  }
  out.off.push_back(run.size() > 1 ? off_line(spec, run, 0, run.size() - 1) : 0.0);
  out.pieces.push_back(std::move(pieces));
  out.spec.members.push_back(std::move(member));
}

joint::End turned(joint::End end, bool turned) {
  return (end == joint::End::start) == turned ? joint::End::finish : joint::End::start;
}

bool same(const StatedJoint& a, const StatedJoint& b) {
  return a.other == b.other && a.plate == b.plate && a.end == b.end && a.how == b.how &&
         (!a.of_members() ? a.member == b.member && a.with == b.with
                          : std::minmax(a.member, a.with) == std::minmax(b.member, b.with));
}

/// Adds the joints of the merged members: joints between pieces of one member are dropped, equal
/// ones are merged.
Result<void> add_joints(const FrameSpec& spec, const MergeSpec& besides, Merged& out) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> of_pair;
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    auto one = spec.joints[i];
    const auto place = out.of[one.member];
    one.member = place.member;
    if (!one.of_members() && !(one.plate && one.how.kind == How::Kind::through)) {
      TRY(const auto end, detail::end_at(spec, i));
      one.end = turned(end, place.turned);
    }
    if (one.of_members()) {
      const auto with = out.of[one.with];
      one.with = with.member;
      if (one.member == one.with) continue;
      if (one.end && place.turned != with.turned) one.end.reset();
      if (one.end) one.end = turned(*one.end, place.turned);
    }
    auto& before = of_pair[{std::min(one.member, one.with), std::max(one.member, one.with)}];
    const bool again = std::ranges::any_of(before, [&](std::size_t k) {
      return same(out.spec.joints[k], one) && besides.alike(out.joints[k], i);
    });
    if (again) continue;
    before.push_back(out.spec.joints.size());
    out.spec.joints.push_back(one);
    out.joints.push_back(i);
  }
  return {};
}

}  // namespace

Result<Merged> merge_in_line(const FrameSpec& spec, const MergeSpec& besides) {
  TRY(const auto of, mates(spec, besides));
  std::vector<Run> all;
  for (const auto& run : runs(of))
    for (auto& one : straight(spec, run)) all.push_back(as_earliest(std::move(one)));
  std::ranges::sort(all, {}, [](const Run& run) { return *std::ranges::min_element(run); });
  Merged out;
  out.spec.others = spec.others;
  out.spec.within = spec.within;
  out.spec.plates = spec.plates;
  out.spec.found = spec.found;
  out.of.resize(spec.members.size());
  for (const auto& run : all) add_member(spec, run, out);
  TRY(add_joints(spec, besides, out));
  return out;
}

}  // namespace tubecut::frame
