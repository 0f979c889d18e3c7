#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "core/base/try.hpp"
#include "core/joint/nearness.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/node_parts.hpp"

namespace tubecut::joint {
namespace detail {
namespace {

std::string place_of(std::size_t member) { return "members/" + std::to_string(member); }
using joint::place_of;

AxisSegment axis_segment(const Member& m, double reach) { return {m.start, m.finish, reach}; }

/// Checks a member that is not round: its height lies along its `up`.
Result<void> check_section(const Member& m) {
  TRY(section::check(*m.section));
  constexpr const char* kHint = "a section requires it: its height lies along it";
  const auto no_direction = [](double got) {
    return fail({.code = ErrorCode::bad_reference_direction,
                 .member = "up",
                 .got = got,
                 .limit = kParallel * kDegPerRad,
                 .unit = "deg",
                 .hint = kHint});
  };
  if (!m.up) return no_direction(0.0);
  const auto frame = member_frame(m.start, m.finish, *m.up);
  if (frame) return {};
  auto error = frame.error();
  for (auto& issue : error.issues) {
    issue.member = "up";
    if (issue.hint.empty()) issue.hint = "it lies along the member; name a direction across it";
  }
  return tl::unexpected(std::move(error));
}

Result<void> check(const NodeSpec& spec) {
  for (std::size_t i = 0; i < spec.members.size(); ++i)
    if (!((spec.members[i].finish - spec.members[i].start).norm() > 0.0))
      return zero_length(place_of(i));
  for (std::size_t i = 0; i < spec.members.size(); ++i)
    if (spec.members[i].section) TRY(under(place_of(i), check_section(spec.members[i])));
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

/// Returns true if the member of the end runs along the other, at an angle of at most `sine`, but
/// next to it: the two are not pieces of one line.
bool runs_along(const NodeSpec& spec, const Touch& touch, double sine) {
  const auto& own = spec.members[touch.end / 2];
  const auto& other = spec.members[touch.other];
  if (!(sine_between(own, other) < sine)) return false;
  const Eigen::Vector3d along = (other.finish - other.start).normalized();
  return (own.at(end_of(touch.end)) - other.start).cross(along).norm() > 0.5 * own.reach();
}

/// Returns true if the member of the end runs along the other, or touches it before its end: a
/// picket in front of a rail.
bool lies_next_to(const NodeSpec& spec, const Touch& touch) {
  constexpr double kTouch = 0.1;  // mm
  if (runs_along(spec, touch, kNearParallel)) return true;
  const auto& own = spec.members[touch.end / 2];
  const auto& other = spec.members[touch.other];
  const double apart =
      nearness(AxisSegment{own.start, own.finish}, AxisSegment{other.start, other.finish});
  return apart < touch.near.distance - kTouch && apart < own.reach() + other.reach() + kTouch;
}

Result<Joined> joined_within(const NodeSpec& spec, double distance) {
  std::vector<AxisSegment> segments;
  for (const auto& m : spec.members) segments.push_back(axis_segment(m, distance + m.reach()));
  TRY(const auto found, touches(segments, kMostCutters));
  Joined out(2 * spec.members.size());
  for (const auto& touch : found)
    if (!runs_along(spec, touch, kInLine)) out[touch.end].push_back(touch);
  return out;
}

Result<Joined> joined_by(const NodeSpec& spec, const std::vector<Link>& links) {
  Joined out(2 * spec.members.size());
  for (const auto& link : links) {
    const auto end = 2 * link.member + (link.end == End::finish ? 1 : 0);
    for (const auto to : link.to)
      if (std::ranges::find(out[end], to, &Touch::other) == out[end].end())
        out[end].push_back({end, to,
                            nearness(spec.members[link.member].at(link.end),
                                     axis_segment(spec.members[to], 0.0))});
    if (out[end].size() > kMostCutters)
      return fail({.code = ErrorCode::wrong_count,
                   .member = place_of(link.member, link.end),
                   .got = static_cast<double>(out[end].size()),
                   .limit = static_cast<double>(kMostCutters)});
  }
  return out;
}

}  // namespace

Result<Joined> connected(const NodeSpec& spec) {
  TRY(check(spec));
  if (const auto* within = std::get_if<Within>(&spec.connect))
    return joined_within(spec, within->distance);
  return joined_by(spec, std::get<std::vector<Link>>(spec.connect));
}

Result<Missed> missed(const NodeSpec& spec, const Joined& joined) {
  const auto* within = std::get_if<Within>(&spec.connect);
  if (within == nullptr) return Missed(joined.size());
  constexpr double kTimes = 3.0;
  std::vector<AxisSegment> segments;
  for (const auto& m : spec.members)
    segments.push_back(axis_segment(m, kTimes * (within->distance + m.reach())));
  std::vector<bool> free;
  for (const auto& touches : joined) free.push_back(touches.empty());
  TRY(auto out, nearest_touches(segments, free));
  const auto joins = [&](std::size_t end, std::size_t other) {
    return std::ranges::count(joined[end], other, &Touch::other) > 0;
  };
  for (std::size_t end = 0; end < out.size(); ++end) {
    if (!out[end]) continue;
    const auto other = out[end]->other;
    const bool runs_past = joins(2 * other, end / 2) || joins(2 * other + 1, end / 2);
    if (joins(end ^ 1U, other) || runs_past || lies_next_to(spec, *out[end])) out[end].reset();
  }
  return out;
}

}  // namespace detail

Result<std::vector<std::optional<std::size_t>>> continued(const NodeSpec& spec) {
  TRY(auto joined, detail::connected(spec));
  const auto lines = detail::lines_of(spec, joined);
  detail::part_passing(spec, joined);
  std::vector<std::optional<std::size_t>> out(joined.size());
  for (std::size_t p = 0; p < joined.size(); ++p)
    if (const auto& mate = lines.mates[p];
        mate && !detail::separated(spec, joined, lines, p, mate->end))
      out[p] = mate->end;
  return out;
}

}  // namespace tubecut::joint
