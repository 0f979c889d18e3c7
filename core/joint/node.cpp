#include "core/joint/node.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/joint/nearness.hpp"
#include "core/joint/node_parts.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kEquallyNear = 1e-6;                  // mm: two chords at the same distance
constexpr double kNearParallel = 0.08715574274765817;  // sin 5 deg

std::string place_of(std::size_t member) { return "members/" + std::to_string(member); }
std::string called(const NodeSpec& spec, std::size_t member) {
  const auto& name = spec.members[member].name;
  return name.empty() ? "member " + std::to_string(member) : name;
}

/// Does `a` cut `b` where they join? A total order, so two members never cut each other.
bool goes_before(const NodeSpec& spec, std::size_t a, std::size_t b) {
  const auto& p = spec.members[a];
  const auto& q = spec.members[b];
  if (p.priority != q.priority) return p.priority < q.priority;
  if (p.outer_radius != q.outer_radius) return p.outer_radius > q.outer_radius;
  return a < b;
}
bool alike(const Member& a, const Member& b) {
  return a.priority == b.priority && a.outer_radius == b.outer_radius;
}

Stretch stretch(const Member& m, double reach) { return {m.start, m.finish, reach}; }

Result<void> check(const NodeSpec& spec) {
  for (std::size_t i = 0; i < spec.members.size(); ++i)
    if (!((spec.members[i].finish - spec.members[i].start).norm() > 0.0))
      return fail({.code = ErrorCode::zero_length, .member = place_of(i)});
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

/// What joins each end: others in index order, with how near they are.
using Joined = std::vector<std::vector<Touch>>;

Result<Joined> joined_within(const NodeSpec& spec, double distance, const std::stop_token& stop) {
  std::vector<Stretch> stretches;
  for (const auto& m : spec.members) stretches.push_back(stretch(m, distance + m.outer_radius));
  const auto found = touches(stretches, kMostCutters, stop);
  if (!found) return tl::unexpected(found.error());
  Joined out(2 * spec.members.size());
  for (const auto& touch : *found) out[touch.end].push_back(touch);
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

/// Two members that pass this end, alike in rank and equally near: which one is the chord?
Result<void> check_ambiguous(const NodeSpec& spec, const std::vector<Touch>& above, double within) {
  const Touch* nearest = nullptr;
  const Touch* second = nullptr;
  for (const auto& touch : above) {
    const auto& other = spec.members[touch.other];
    const bool passing = touch.near.inside > within + other.outer_radius;
    if (!passing || !alike(other, spec.members[above.front().other])) continue;
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

/// Sine of the angle between two members.
double sine_between(const Member& a, const Member& b) {
  return (a.finish - a.start).normalized().cross((b.finish - b.start).normalized()).norm();
}

/// The cutters of one end, the chord first; parallel members are noted and do not cut.
std::vector<Touch> cutters_of(const NodeSpec& spec, std::size_t member, End end,
                              const std::vector<Touch>& joined, std::vector<Warning>& warnings) {
  std::vector<Touch> out;
  for (const auto& touch : joined) {
    const double sine = sine_between(spec.members[member], spec.members[touch.other]);
    if (!goes_before(spec, touch.other, member)) continue;
    if (sine < 2.0 * kParallel) {
      warnings.push_back(
          {.code = WarningCode::parallel_members,
           .member = place_of(member, end),
           .detail = called(spec, touch.other) + " is parallel and does not cut it"});
      continue;
    }
    if (sine < kNearParallel)
      warnings.push_back({.code = WarningCode::near_parallel,
                          .member = place_of(member, end),
                          .detail = called(spec, touch.other) + " is within 5 deg of parallel"});
    out.push_back(touch);
  }
  std::ranges::sort(
      out, [&](const Touch& a, const Touch& b) { return goes_before(spec, a.other, b.other); });
  return out;
}

Result<std::vector<CutBy>> place_cutters(const NodeSpec& spec, const Member& member,
                                         const MemberFrame& frame,
                                         const std::vector<Touch>& cutters) {
  std::vector<CutBy> out;
  for (const auto& touch : cutters) {
    const auto& other = spec.members[touch.other];
    auto placed = place(frame.local(AxisLine{other.start, other.finish - other.start}),
                        other.outer_radius, place_of(touch.other));
    if (!placed) return tl::unexpected(placed.error());
    if (!member.up && out.empty()) placed->tube.clocking = Angle{};  // the frame was made so
    out.push_back({.member = touch.other,
                   .placement = *placed,
                   .gap = touch.near.distance,
                   .eccentricity = std::abs(placed->tube.offset)});
  }
  return out;
}

void warn(const NodeSpec& spec, const MemberEnd& end, bool by_distance, std::vector<Warning>& out) {
  const auto at = place_of(end.member, end.end);
  if (end.free && by_distance)
    out.push_back({.code = WarningCode::free_end,
                   .member = at,
                   .detail = called(spec, end.member) + " meets no member here"});
  for (const auto& cut : end.cut_by)
    if (cut.ghost)
      out.push_back({.code = WarningCode::ghost_contact,
                     .member = at,
                     .detail = "cut by " + called(spec, cut.member) + " beyond that member's end"});
  if (end.open) out.push_back({.code = WarningCode::end_open, .member = at});
  if (end.consumed) out.push_back({.code = WarningCode::end_consumed, .member = at});
}

Result<MemberEnd> solve_end(const NodeSpec& spec, std::size_t index,
                            const std::vector<Touch>& joined, std::vector<Warning>& warnings) {
  MemberEnd out{.member = index / 2, .end = index % 2 == 0 ? End::start : End::finish};
  out.free = joined.empty();
  const auto* within = std::get_if<Within>(&spec.connect);
  const auto cutters = cutters_of(spec, out.member, out.end, joined, warnings);
  if (within != nullptr && !cutters.empty())
    if (auto ok = check_ambiguous(spec, cutters, within->distance); !ok)
      return tl::unexpected(ok.error());
  std::optional<Vector3d> chord;
  if (!cutters.empty()) {
    const auto& first = spec.members[cutters.front().other];
    chord = first.finish - first.start;
  }
  const auto frame = frame_of(spec, out.member, out.end, chord);
  if (!frame) return tl::unexpected(frame.error());
  out.frame = *frame;
  auto placed = place_cutters(spec, spec.members[out.member], out.frame, cutters);
  if (!placed) return tl::unexpected(placed.error());
  out.cut_by = *std::move(placed);
  if (!out.cut_by.empty()) detail::inspect(spec, out);
  warn(spec, out, within != nullptr, warnings);
  return out;
}

}  // namespace

std::string place_of(std::size_t member, End end) {
  return place_of(member) + (end == End::start ? "/start" : "/end");
}

Result<Nodes> solve(const NodeSpec& spec, const std::stop_token& stop) {
  if (auto ok = check(spec); !ok) return tl::unexpected(ok.error());
  const auto* within = std::get_if<Within>(&spec.connect);
  const auto joined = within != nullptr
                          ? joined_within(spec, within->distance, stop)
                          : joined_by(spec, std::get<std::vector<Link>>(spec.connect));
  if (!joined) return tl::unexpected(joined.error());
  Nodes out;
  out.ends.reserve(joined->size());
  for (std::size_t i = 0; i < joined->size(); ++i) {
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    auto end = solve_end(spec, i, (*joined)[i], out.warnings);
    if (!end) return tl::unexpected(end.error());
    out.ends.push_back(*std::move(end));
  }
  return out;
}

EndJoint joint_of(const NodeSpec& spec, const MemberEnd& end) {
  const auto& m = spec.members[end.member];
  EndJoint out{.target = {.outer_radius = m.outer_radius,
                          .wall = m.wall,
                          .length = (m.finish - m.start).norm()},
               .partners = {},
               .member = end.member,
               .cutters = {},
               .warnings = {}};
  for (const auto& cut : end.cut_by) {
    out.partners.emplace_back(cut.placement.tube);
    out.cutters.push_back(cut.member);
  }
  return out;
}

Result<EndJoint> joint_at(const NodeSpec& spec, std::size_t member, End end,
                          const std::stop_token& stop) {
  const auto nodes = solve(spec, stop);
  if (!nodes) return tl::unexpected(nodes.error());
  const auto at = place_of(member, end);
  const auto& found = nodes->ends[2 * member + (end == End::finish ? 1 : 0)];
  if (found.cut_by.empty())
    return fail({.code = ErrorCode::no_contact,
                 .member = at,
                 .hint = found.free ? "this end joins no member"
                                    : "no member that joins this end cuts it"});
  auto out = joint_of(spec, found);
  for (const auto& warning : nodes->warnings)
    if (warning.member == at && warning.code != WarningCode::near_parallel)
      out.warnings.push_back(warning);
  return out;
}

Result<std::vector<std::optional<Intersection>>> profiles(const NodeSpec& spec, const Nodes& nodes,
                                                          const Sampling& sampling,
                                                          const std::stop_token& stop) {
  std::vector<std::optional<Intersection>> out(nodes.ends.size());
  auto left = sampling;
  for (std::size_t i = 0; i < nodes.ends.size(); ++i) {
    const auto& end = nodes.ends[i];
    if (end.cut_by.empty() || end.open || end.consumed) continue;
    auto joint = joint_of(spec, end);
    auto curves = intersect({.target = joint.target,
                             .partners = std::move(joint.partners),
                             .surfaces = Surfaces::both,
                             .sampling = left},
                            stop);
    if (!curves) {
      const auto code = curves.error().code();
      if (code == ErrorCode::member_consumed || code == ErrorCode::open_profile ||
          code == ErrorCode::no_contact)
        continue;
      return tl::unexpected(curves.error());
    }
    std::size_t used = 0;
    for (const auto& profile : curves->profiles) used += profile.phi.size();
    if (used > left.max_nodes)
      return fail({.code = ErrorCode::too_many_nodes,
                   .member = "sampling",
                   .got = static_cast<double>(sampling.max_nodes - left.max_nodes + used),
                   .limit = static_cast<double>(sampling.max_nodes)});
    left.max_nodes -= used;
    out[i] = *std::move(curves);
  }
  return out;
}

}  // namespace tubecut::joint
