#include "core/joint/node/node.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/nearness.hpp"
#include "core/joint/node/corner_mitre.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/shape.hpp"
#include "core/joint/node/shared_corner.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kEquallyNear = 1e-6;  // mm: two chords at the same distance

using detail::Applied;
using detail::called;
using detail::Joined;
using detail::Lines;
using detail::Presence;
using detail::sine_between;

std::string place_of(std::size_t member) { return "members/" + std::to_string(member); }
bool alike(const Member& a, const Member& b) {
  return a.priority == b.priority && a.half_size() == b.half_size();
}

/// One member that cuts an end: its tube, or a mitre's plane.
struct Cutting {
  Touch touch;
  const detail::Mitre* mitre = nullptr;
  bool flat = false;  // by its faces, because another end shares its corner
  bool wide = false;  // by a face that goes on to both sides, because the end is wider
};

/// Returns the error if two members that pass this end are equal in rank and equally near, so that
/// the chord is ambiguous.
Result<void> check_ambiguous(const NodeSpec& spec, const std::vector<Cutting>& above,
                             double within) {
  const Touch* nearest = nullptr;
  const Touch* second = nullptr;
  for (const auto& [touch, mitre, flat, wide] : above) {
    const auto& other = spec.members[touch.other];
    const bool passing = touch.near.inside > within + other.reach();
    if (!passing || !alike(other, spec.members[above.front().touch.other])) continue;
    if (nearest == nullptr || touch.near.distance < nearest->near.distance)
      second = std::exchange(nearest, &touch);
    else if (second == nullptr || touch.near.distance < second->near.distance)
      second = &touch;
  }
  if (second == nullptr || second->near.distance - nearest->near.distance > kEquallyNear) return {};
  const auto [a, b] = std::minmax(nearest->other, second->other);
  const auto end = nearest->end;
  return fail({.code = ErrorCode::ambiguous_connection,
               .member = place_of(end / 2, end % 2 == 0 ? End::start : End::finish),
               .got = called(spec, a) + ", " + called(spec, b),
               .unit = {},
               .hint = called(spec, a) + " and " + called(spec, b) +
                       " pass this end equally near and are alike; name the connection, or give "
                       "one the smaller priority"});
}

/// Returns the world axis furthest from `z`, the first of equals.
Vector3d any_reference(const Vector3d& z) {
  int axis = 0;
  z.cwiseAbs().minCoeff(&axis);
  return Vector3d::Unit(axis);
}

Result<MemberFrame> frame_of(const NodeSpec& spec, std::size_t member, End end,
                             const std::optional<Vector3d>& chord) {
  const auto& m = spec.members[member];
  const Vector3d& cut = m.at(end);
  const Vector3d& far = m.at(end == End::start ? End::finish : End::start);
  const Vector3d z = (far - cut).normalized();
  const Vector3d reference = m.up ? *m.up : chord ? chord_reference(z, *chord) : any_reference(z);
  auto frame = member_frame(cut, far, reference);
  if (!frame) {
    auto error = frame.error();
    for (auto& issue : error.issues) issue.member = place_of(member) + "/up";
    return tl::unexpected(std::move(error));
  }
  return frame;
}

/// The surroundings of an end, and the known joints.
struct Around {
  const Applied& applied;
  const Lines& lines;
  const Joined& all;
  const std::vector<Touch>& joined;  // of this end
  const std::vector<detail::SharedCorner>& corners;
  const std::optional<Touch>& missed;
};

/// Returns "X is within 0.012 deg of parallel".
std::string parallel_to(const NodeSpec& spec, std::size_t member, std::size_t other) {
  const double off = elementary::asin(sine_between(spec.members[member], spec.members[other]));
  const auto name = called(spec, other);
  if (off < 2.0 * kParallel) return name + " is parallel";
  return name + " is within " + brief(off * kDegPerRad) + " deg of parallel";
}

/// Two ends that share a chord's corner end flat on its faces, and neither cuts the other.
void part_at_corners(const std::vector<detail::SharedCorner>& shared,
                     std::vector<Cutting>& cutters) {
  std::vector<std::size_t> parted;
  for (auto& cutting : cutters)
    for (const auto& [chord, other] : shared)
      if (cutting.mitre == nullptr && cutting.touch.other == chord) {
        cutting.flat = true;
        parted.push_back(other);
      }
  std::erase_if(cutters, [&](const Cutting& c) {
    return c.mitre == nullptr && std::ranges::count(parted, c.touch.other) > 0;
  });
}

/// Returns the cutters of one end, the chord first. Parallel members get a warning and do not cut;
/// members of the end's own line cut it only at a mitre's plane.
std::vector<Cutting> cutters_of(const NodeSpec& spec, std::size_t index, const Around& around,
                                std::vector<Warning>& warnings) {
  const auto member = index / 2;
  const auto& lines = around.lines;
  std::vector<Cutting> out;
  for (const auto& touch : around.joined) {
    if (const auto mitre = around.applied.mitres.find({index, touch.other});
        mitre != around.applied.mitres.end()) {
      out.push_back({touch, &mitre->second});
      continue;
    }
    const double sine = sine_between(spec.members[member], spec.members[touch.other]);
    const bool same = lines.line[member] == lines.line[touch.other];
    if (same && sine < elementary::sin(kInLineMost)) continue;
    if (!lines.goes_before(spec, touch.other, member)) continue;
    if (sine < 2.0 * kParallel) {
      warnings.push_back(
          {.code = WarningCode::parallel_members,
           .member = place_of(member, end_of(index)),
           .detail = parallel_to(spec, member, touch.other) + " and does not cut it"});
      continue;
    }
    out.push_back({touch});
  }
  std::ranges::sort(out, [&](const Cutting& a, const Cutting& b) {
    return lines.listed_before(spec, a.touch.other, b.touch.other);
  });
  part_at_corners(around.corners, out);
  for (auto& one : out)
    for (auto& other : out)
      if (one.mitre == nullptr && other.mitre == nullptr &&
          detail::flush_at_mitre({spec, around.applied, around.lines, around.all}, index,
                                 {one.touch.other, other.touch.other}))
        one.flat = other.flat = true;
  return out;
}

/// Returns the first cutter that defines a direction, which determines phase zero. A face that is
/// nearly square defines none.
const Cutting* chord_of(const NodeSpec& spec, std::size_t member,
                        const std::vector<Cutting>& cutters) {
  for (const auto& one : cutters) {
    const double least = one.mitre != nullptr ? elementary::sin(kButtMost) : 2.0 * kParallel;
    if (sine_between(spec.members[member], spec.members[one.touch.other]) >= least) return &one;
  }
  return nullptr;
}

std::optional<Joint> joint_with(const NodeSpec& spec, const Applied& applied, std::size_t member,
                                std::size_t other) {
  const auto stated = applied.joints.find(std::minmax(member, other));
  if (stated == applied.joints.end()) return std::nullopt;
  auto out = stated->second;
  if (out.kind == JointKind::set_in && !out.depth) out.depth = spec.members[other].thickness();
  return out;
}

Result<std::vector<CutBy>> place_cutters(const NodeSpec& spec, const Applied& applied,
                                         std::size_t member, const MemberFrame& frame,
                                         const Cutting* chord,
                                         const std::vector<Cutting>& cutters) {
  std::vector<CutBy> out;
  for (const auto& one : cutters) {
    const auto& [touch, mitre, flat, wide] = one;
    const auto& own = spec.members[touch.other];
    const auto other = wide ? detail::as_met(own, spec.members[member]) : own;
    CutBy cut{.member = touch.other,
              .placement = {},
              .stated = joint_with(spec, applied, member, touch.other),
              .gap = touch.near.distance};
    const AxisLine axis{other.start, other.finish - other.start};
    if (mitre != nullptr) {
      cut.plane = PlaneCutter{frame.rows * mitre->point, frame.rows * mitre->normal};
      cut.eccentricity = mitre->eccentricity;
    } else {
      TRY(cut.placement, under(place_of(touch.other), place(frame.local(axis), other.reach())));
      if (other.section) cut.box = box_of(other, frame);
      if (flat) cut.box->corner = detail::kSharpCorner;
      // The frame was defined in this way.
      if (!spec.members[member].up && &one == chord) cut.placement.tube.clocking = Angle{};
      cut.eccentricity = std::abs(cut.placement.tube.offset);
    }
    out.push_back(std::move(cut));
  }
  return out;
}

Result<MemberEnd> place_end(const NodeSpec& spec, std::size_t index, const Around& around,
                            const std::vector<Cutting>& cutters) {
  MemberEnd out{.member = index / 2, .end = end_of(index)};
  out.free = around.joined.empty();
  const auto* first = chord_of(spec, out.member, cutters);
  std::optional<Vector3d> chord;
  if (first != nullptr) {
    const auto& m = spec.members[first->touch.other];
    chord = m.finish - m.start;
  }
  TRY(const auto frame, frame_of(spec, out.member, out.end, chord));
  out.frame = frame;
  TRY(auto placed, place_cutters(spec, around.applied, out.member, out.frame, first, cutters));
  out.cut_by = std::move(placed);
  return out;
}

/// Returns the reason if one of the cutters of an end does not cut it; empty when it cuts.
std::optional<Warning> no_cutter(const NodeSpec& spec, const MemberEnd& end, const Around& around,
                                 std::size_t index, const Presence& seen) {
  const auto& cut = end.cut_by[index];
  const auto pair = std::minmax(end.member, cut.member);
  const bool stated = around.applied.joints.contains(pair) && !around.applied.found.contains(pair);
  const bool found = !stated && std::holds_alternative<Within>(spec.connect);
  const auto at = place_of(end.member, end.end);
  if (found && !cut.plane && seen.passes)
    return Warning{WarningCode::free_end, at,
                   called(spec, end.member) + " meets no member here: it runs past " +
                       called(spec, cut.member)};
  if (cut.plane || !(seen.anywhere || seen.flush)) return std::nullopt;
  const double sine = sine_between(spec.members[end.member], spec.members[cut.member]);
  if (seen.consumes && sine < detail::kNearParallel)
    return Warning{WarningCode::parallel_members, at,
                   parallel_to(spec, end.member, cut.member) + " and does not cut it: the cut " +
                       "would begin " + brief(seen.highest) + " mm from the end"};
  if (!found || seen.there) return std::nullopt;
  return Warning{WarningCode::free_end, at,
                 called(spec, end.member) + " meets no member here: " + called(spec, cut.member) +
                     " ends " + brief(seen.nearest) + " mm before it would cut it"};
}

/// Lets the cutters of an open end that are narrower than it cut it by their whole faces. Returns
/// false if there are none that did not yet.
bool widen(const NodeSpec& spec, std::size_t member, std::vector<Cutting>& cutters) {
  bool any = false;
  for (auto& one : cutters) {
    const auto& chord = spec.members[one.touch.other];
    if (one.mitre != nullptr || one.wide || !chord.section ||
        *detail::as_met(chord, spec.members[member]).section == *chord.section)
      continue;
    one.wide = any = true;
  }
  return any;
}

/// Drops the first cutter that does not cut, and repeats without it until all others cut.
Result<MemberEnd> solve_end(const NodeSpec& spec, std::size_t index, const Around& around,
                            std::vector<Warning>& warnings) {
  auto cutters = cutters_of(spec, index, around, warnings);
  const auto* within = std::get_if<Within>(&spec.connect);
  if (within != nullptr && !cutters.empty()) TRY(check_ambiguous(spec, cutters, within->distance));
  std::vector<Warning> left_out;
  for (;;) {
    TRY(auto out, place_end(spec, index, around, cutters));
    std::optional<std::size_t> none;
    if (!cutters.empty()) {
      const auto seen = detail::inspect({spec, around.applied, around.lines, around.all}, out);
      for (std::size_t i = 0; i < seen.size() && !none; ++i)
        if (auto why = no_cutter(spec, out, around, i, seen[i])) {
          none = i;
          left_out.push_back(*std::move(why));
        }
    }
    if (none) {
      cutters.erase(cutters.begin() + static_cast<std::ptrdiff_t>(*none));
      continue;
    }
    if (out.open && widen(spec, out.member, cutters)) continue;
    for (auto& one : left_out)
      if (one.code != WarningCode::free_end || cutters.empty()) {
        out.free = out.free || one.code == WarningCode::free_end;
        warnings.push_back(std::move(one));
      }
    for (const auto& one : cutters)
      if (one.mitre == nullptr &&
          sine_between(spec.members[out.member], spec.members[one.touch.other]) <
              detail::kNearParallel)
        warnings.push_back(
            {.code = WarningCode::near_parallel,
             .member = place_of(out.member, out.end),
             .detail = called(spec, one.touch.other) + " is within 5 deg of parallel"});
    detail::warn({spec, around.applied, around.lines, around.all}, out, around.missed, warnings);
    return out;
  }
}

Result<Nodes> solve_ends(const detail::Joints& all, const detail::Missed& missed) {
  Nodes out;
  const auto corners = detail::shared_corners(all);
  out.ends.reserve(missed.size());
  for (std::size_t i = 0; i < missed.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const Around around{all.applied, all.lines, all.joined, all.joined[i], corners[i], missed[i]};
    TRY(auto end, solve_end(all.spec, i, around, out.warnings));
    out.ends.push_back(std::move(end));
  }
  return out;
}

}  // namespace

Result<Nodes> solve(const NodeSpec& spec) {
  TRY(auto joined, detail::connected(spec));
  TRY(const auto near, detail::missed(spec, joined));
  const auto lines = detail::lines_of(spec, joined);
  TRY(auto applied, detail::apply_joints(spec, lines, joined));
  detail::join_lines(spec, lines, joined, applied);
  const detail::Joints all{spec, applied, lines, joined};
  TRY(auto out, solve_ends(all, near));
  for (;;) {
    const auto corners = detail::corner_mitres(all, out.ends);
    if (corners.empty()) return out;
    for (const auto& [p, q] : corners) detail::mitre_ends(spec, p, q, joined, applied);
    TRY(auto again, solve_ends(all, near));
    out = std::move(again);
  }
}

}  // namespace tubecut::joint
