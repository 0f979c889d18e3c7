#include "core/joint/node.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/joint/nearness.hpp"
#include "core/joint/node_parts.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kEquallyNear = 1e-6;                  // mm: two chords at the same distance
constexpr double kNearParallel = 0.08715574274765817;  // sin 5 deg
constexpr double kStep = 0.01;  // mm between two mitred edges: as good as none

using detail::Applied;
using detail::called;
using detail::goes_before;
using detail::Joined;
using detail::sine_between;

std::string place_of(std::size_t member) { return "members/" + std::to_string(member); }
bool alike(const Member& a, const Member& b) {
  return a.priority == b.priority && a.outer_radius == b.outer_radius;
}

Stretch stretch(const Member& m, double reach) { return {m.start, m.finish, reach}; }

Result<void> check(const NodeSpec& spec) {
  for (std::size_t i = 0; i < spec.members.size(); ++i)
    if (!((spec.members[i].finish - spec.members[i].start).norm() > 0.0))
      return zero_length(place_of(i));
  const auto* links = std::get_if<std::vector<Link>>(&spec.connect);
  if (links == nullptr) return {};
  const auto n = spec.members.size();
  for (std::size_t k = 0; k < links->size(); ++k) {
    const auto& link = (*links)[k];
    const bool known = link.member < n && std::ranges::all_of(link.to, [&](std::size_t to) {
                         return to < n && to != link.member;
                       });
    if (!known)
      return fail({.code = ErrorCode::out_of_range, .member = "connect/" + std::to_string(k)});
  }
  return {};
}

Result<Joined> joined_within(const NodeSpec& spec, double distance, const std::stop_token& stop) {
  std::vector<Stretch> stretches;
  for (const auto& m : spec.members) stretches.push_back(stretch(m, distance + m.outer_radius));
  TRY(const auto found, touches(stretches, kMostCutters, stop));
  Joined out(2 * spec.members.size());
  for (const auto& touch : found) out[touch.end].push_back(touch);
  return out;
}

/// What each end that joins nothing may have been meant to join: the nearest member within three
/// times the reach, unless the member's other end joins that one already: a short branch is near.
using Missed = std::vector<std::optional<Touch>>;

Result<Missed> missed(const NodeSpec& spec, const Joined& joined, double distance,
                      const std::stop_token& stop) {
  constexpr double kTimes = 3.0;
  std::vector<Stretch> stretches;
  for (const auto& m : spec.members)
    stretches.push_back(stretch(m, kTimes * (distance + m.outer_radius)));
  std::vector<bool> free;
  for (const auto& touches : joined) free.push_back(touches.empty());
  TRY(auto out, nearest_touches(stretches, free, stop));
  for (std::size_t end = 0; end < out.size(); ++end)
    if (out[end] && std::ranges::count(joined[end ^ 1U], out[end]->other, &Touch::other) > 0)
      out[end].reset();
  return out;
}

Result<Joined> joined_by(const NodeSpec& spec, const std::vector<Link>& links) {
  Joined out(2 * spec.members.size());
  for (const auto& link : links) {
    const auto end = 2 * link.member + (link.end == End::finish ? 1 : 0);
    for (const auto to : link.to)
      if (std::ranges::find(out[end], to, &Touch::other) == out[end].end())
        out[end].push_back(
            {end, to,
             nearness(spec.members[link.member].at(link.end), stretch(spec.members[to], 0.0))});
    if (out[end].size() > kMostCutters)
      return fail({.code = ErrorCode::wrong_count,
                   .member = place_of(link.member, link.end),
                   .got = static_cast<double>(out[end].size()),
                   .limit = static_cast<double>(kMostCutters)});
  }
  return out;
}

/// One member that cuts an end: its tube, or a mitre's plane.
struct Cutting {
  Touch touch;
  const detail::Mitre* mitre = nullptr;
};

/// Two members that pass this end, alike in rank and equally near: which one is the chord?
Result<void> check_ambiguous(const NodeSpec& spec, const std::vector<Cutting>& above,
                             double within) {
  const Touch* nearest = nullptr;
  const Touch* second = nullptr;
  for (const auto& [touch, mitre] : above) {
    const auto& other = spec.members[touch.other];
    const bool passing = touch.near.inside > within + other.outer_radius;
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

/// Of the world's axes the one furthest from `z`, the first of equals.
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

/// The cutters of one end, the chord first; parallel members are noted and do not cut.
std::vector<Cutting> cutters_of(const NodeSpec& spec, std::size_t index, const Applied& applied,
                                const std::vector<Touch>& joined, std::vector<Warning>& warnings) {
  const auto member = index / 2;
  const auto at = place_of(member, index % 2 == 0 ? End::start : End::finish);
  std::vector<Cutting> out;
  for (const auto& touch : joined) {
    if (const auto mitre = applied.mitres.find({index, touch.other});
        mitre != applied.mitres.end()) {
      out.push_back({touch, &mitre->second});
      continue;
    }
    const double sine = sine_between(spec.members[member], spec.members[touch.other]);
    if (!goes_before(spec, touch.other, member)) continue;
    if (sine < 2.0 * kParallel) {
      warnings.push_back(
          {.code = WarningCode::parallel_members,
           .member = at,
           .detail = called(spec, touch.other) + " is parallel and does not cut it"});
      continue;
    }
    if (sine < kNearParallel)
      warnings.push_back({.code = WarningCode::near_parallel,
                          .member = at,
                          .detail = called(spec, touch.other) + " is within 5 deg of parallel"});
    out.push_back({touch});
  }
  std::ranges::sort(out, [&](const Cutting& a, const Cutting& b) {
    return goes_before(spec, a.touch.other, b.touch.other);
  });
  return out;
}

/// The first cutter that points somewhere: with it phase zero is found.
const Cutting* chord_of(const NodeSpec& spec, std::size_t member,
                        const std::vector<Cutting>& cutters) {
  for (const auto& one : cutters)
    if (sine_between(spec.members[member], spec.members[one.touch.other]) >= 2.0 * kParallel)
      return &one;
  return nullptr;
}

std::optional<Joint> joint_with(const NodeSpec& spec, const Applied& applied, std::size_t member,
                                std::size_t other) {
  const auto stated = applied.joints.find(std::minmax(member, other));
  if (stated == applied.joints.end()) return std::nullopt;
  auto out = stated->second;
  if (out.kind == JointKind::set_in && !out.depth) out.depth = spec.members[other].wall;
  return out;
}

Result<std::vector<CutBy>> place_cutters(const NodeSpec& spec, const Applied& applied,
                                         std::size_t member, const MemberFrame& frame,
                                         const Cutting* chord,
                                         const std::vector<Cutting>& cutters) {
  std::vector<CutBy> out;
  for (const auto& one : cutters) {
    const auto& [touch, mitre] = one;
    const auto& other = spec.members[touch.other];
    CutBy cut{.member = touch.other,
              .placement = {},
              .stated = joint_with(spec, applied, member, touch.other),
              .gap = touch.near.distance};
    const AxisLine axis{other.start, other.finish - other.start};
    if (mitre != nullptr) {
      cut.plane = PlaneCutter{frame.rows * mitre->point, frame.rows * mitre->normal};
      cut.eccentricity = mitre->eccentricity;
    } else {
      TRY(cut.placement,
          under(place_of(touch.other), place(frame.local(axis), other.outer_radius)));
      // The frame was made so.
      if (!spec.members[member].up && &one == chord) cut.placement.tube.clocking = Angle{};
      cut.eccentricity = std::abs(cut.placement.tube.offset);
    }
    out.push_back(std::move(cut));
  }
  return out;
}

/// How far the outer edges of two mitred ends stand apart at most: both are ellipses in one plane,
/// their centres the axes' distance apart, half as wide as their tubes and longer as these lean.
double mitre_step(const NodeSpec& spec, const MemberEnd& end, const CutBy& cut) {
  if (!cut.plane) return 0.0;
  const auto& other = spec.members[cut.member];
  const double r = spec.members[end.member].outer_radius, s = other.outer_radius;
  const Vector3d normal = cut.plane->normal.normalized();
  const Vector3d along = end.frame.rows * (other.finish - other.start).normalized();
  return std::max(std::abs(r / normal.z() - s / std::abs(normal.dot(along))), std::abs(r - s)) +
         cut.eccentricity;
}

void warn(const NodeSpec& spec, const MemberEnd& end, const std::optional<Touch>& missed,
          std::vector<Warning>& out) {
  const auto at = place_of(end.member, end.end);
  if (missed) {
    const double off = missed->near.distance - spec.members[missed->other].outer_radius;
    out.push_back({.code = WarningCode::free_end,
                   .member = at,
                   .detail = called(spec, end.member) + " meets no member here, and misses " +
                             called(spec, missed->other) + " by " + brief(off) + " mm"});
  }
  for (const auto& cut : end.cut_by)
    if (cut.ghost)
      out.push_back({.code = WarningCode::ghost_contact,
                     .member = at,
                     .detail = "cut by " + called(spec, cut.member) + " beyond that member's end"});
  for (const auto& cut : end.cut_by)
    if (const double step = mitre_step(spec, end, cut); step > kStep)
      out.push_back({.code = WarningCode::mitre_steps,
                     .member = at,
                     .detail = "its edge and that of " + called(spec, cut.member) +
                               " stand up to " + shown(step) + " mm apart"});
  if (end.open) out.push_back({.code = WarningCode::end_open, .member = at});
  if (end.consumed) out.push_back({.code = WarningCode::end_consumed, .member = at});
}

Result<MemberEnd> solve_end(const NodeSpec& spec, std::size_t index, const Applied& applied,
                            const std::vector<Touch>& joined, const std::optional<Touch>& missed,
                            std::vector<Warning>& warnings) {
  MemberEnd out{.member = index / 2, .end = index % 2 == 0 ? End::start : End::finish};
  out.free = joined.empty();
  const auto* within = std::get_if<Within>(&spec.connect);
  const auto cutters = cutters_of(spec, index, applied, joined, warnings);
  if (within != nullptr && !cutters.empty()) TRY(check_ambiguous(spec, cutters, within->distance));
  const auto* first = chord_of(spec, out.member, cutters);
  std::optional<Vector3d> chord;
  if (first != nullptr) {
    const auto& m = spec.members[first->touch.other];
    chord = m.finish - m.start;
  }
  TRY(const auto frame, frame_of(spec, out.member, out.end, chord));
  out.frame = frame;
  TRY(auto placed, place_cutters(spec, applied, out.member, out.frame, first, cutters));
  out.cut_by = std::move(placed);
  if (!out.cut_by.empty()) detail::inspect(spec, out);
  warn(spec, out, missed, warnings);
  return out;
}

}  // namespace

Result<Nodes> solve(const NodeSpec& spec, const std::stop_token& stop) {
  TRY(check(spec));
  const auto* within = std::get_if<Within>(&spec.connect);
  TRY(auto joined, within != nullptr ? joined_within(spec, within->distance, stop)
                                     : joined_by(spec, std::get<std::vector<Link>>(spec.connect)));
  Missed near(joined.size());
  if (within != nullptr) {
    TRY(near, missed(spec, joined, within->distance, stop));
  }
  TRY(const auto applied, detail::apply_joints(spec, joined));
  Nodes out;
  out.ends.reserve(joined.size());
  for (std::size_t i = 0; i < joined.size(); ++i) {
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    TRY(auto end, solve_end(spec, i, applied, joined[i], near[i], out.warnings));
    out.ends.push_back(std::move(end));
  }
  return out;
}

}  // namespace tubecut::joint
