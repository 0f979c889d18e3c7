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

Stretch stretch(const Member& m, double reach) { return {m.start, m.finish, reach}; }

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
  for (auto& issue : error.issues) issue.member = "up";
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

Result<Joined> joined_within(const NodeSpec& spec, double distance, const std::stop_token& stop) {
  std::vector<Stretch> stretches;
  for (const auto& m : spec.members) stretches.push_back(stretch(m, distance + m.reach()));
  TRY(const auto found, touches(stretches, kMostCutters, stop));
  Joined out(2 * spec.members.size());
  for (const auto& touch : found) out[touch.end].push_back(touch);
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

}  // namespace

Result<Joined> connected(const NodeSpec& spec, const std::stop_token& stop) {
  TRY(check(spec));
  if (const auto* within = std::get_if<Within>(&spec.connect))
    return joined_within(spec, within->distance, stop);
  return joined_by(spec, std::get<std::vector<Link>>(spec.connect));
}

Result<Missed> missed(const NodeSpec& spec, const Joined& joined, const std::stop_token& stop) {
  const auto* within = std::get_if<Within>(&spec.connect);
  if (within == nullptr) return Missed(joined.size());
  constexpr double kTimes = 3.0;
  std::vector<Stretch> stretches;
  for (const auto& m : spec.members)
    stretches.push_back(stretch(m, kTimes * (within->distance + m.reach())));
  std::vector<bool> free;
  for (const auto& touches : joined) free.push_back(touches.empty());
  TRY(auto out, nearest_touches(stretches, free, stop));
  for (std::size_t end = 0; end < out.size(); ++end)
    if (out[end] && std::ranges::count(joined[end ^ 1U], out[end]->other, &Touch::other) > 0)
      out[end].reset();
  return out;
}

}  // namespace detail

Result<std::vector<std::optional<std::size_t>>> continued(const NodeSpec& spec,
                                                          const std::stop_token& stop) {
  TRY(auto joined, detail::connected(spec, stop));
  const auto lines = detail::lines_of(spec, joined);
  TRY(const auto applied, detail::apply_joints(spec, lines, joined));
  std::vector<std::optional<std::size_t>> out(joined.size());
  for (std::size_t p = 0; p < joined.size(); ++p)
    if (const auto& mate = lines.mates[p];
        mate && !detail::separated(spec, joined, lines, p, mate->end))
      out[p] = mate->end;
  return out;
}

}  // namespace tubecut::joint
