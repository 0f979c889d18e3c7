#include "core/frame/frame.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/try.hpp"
#include "core/frame/frame_parts.hpp"
#include "core/joint/nearness.hpp"
#include "core/joint/node/body_overlap.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/overlap.hpp"

namespace tubecut::frame {
namespace {

using detail::Joined;
using Eigen::Vector3d;
using joint::End;

constexpr double kEquallyNear = 1e-6;  // mm

std::string at_joint(std::size_t i) { return "joints/" + std::to_string(i); }
std::string at_other(std::size_t i) { return "others/" + std::to_string(i); }

tl::unexpected<Error> contradicts(std::size_t joint, const std::string& field,
                                  const std::string& hint) {
  return fail({.code = ErrorCode::joint_contradicts,
               .member = at_joint(joint) + (field.empty() ? "" : "/" + field),
               .hint = hint});
}

/// Returns the kind for core's nodes, where a butt joint is a mitre of two members in line.
joint::JointKind of_node(How::Kind kind) {
  switch (kind) {
    case How::Kind::set_on:
      return joint::JointKind::set_on;
    case How::Kind::set_in:
      return joint::JointKind::set_in;
    case How::Kind::through:
      return joint::JointKind::through;
    case How::Kind::mitre:
    case How::Kind::butt:
      break;
  }
  return joint::JointKind::mitre;
}
joint::Joint of_node(const How& how) { return {of_node(how.kind), how.gap, how.depth, how.plane}; }

/// Returns the direction vectors of a body; each must have a length above 0.
struct Directions {
  using All = std::vector<std::pair<std::string, Vector3d>>;
  All operator()(const joint::AxisTube& t) const { return {{"axis/direction", t.axis.direction}}; }
  All operator()(const joint::TubeCutter&) const { return {}; }
  All operator()(const joint::PlaneCutter& p) const { return {{"normal", p.normal}}; }
  All operator()(const joint::RectangularTubeCutter& t) const {
    return {{"axis/direction", t.direction}, {"up", t.up}};
  }
  All operator()(const joint::ConeCutter& c) const { return {{"axis/direction", c.direction}}; }
  All operator()(const joint::ElbowCutter& e) const {
    return {{"axis/direction", e.direction}, {"inwards", e.inwards}};
  }
};

Result<void> check_others(const FrameSpec& spec) {
  for (std::size_t i = 0; i < spec.others.size(); ++i)
    for (const auto& [field, v] : joint::by_kind(spec.others[i].partner, Directions{}))
      if (!(v.norm() > 0.0))
        return fail({.code = ErrorCode::zero_length,
                     .member = at_other(i) + "/" + field,
                     .got = 0.0,
                     .limit = 0.0,
                     .hint = "the vector's length must be greater than the limit"});
  return {};
}

/// Distance from a point to the surface, unsigned.
struct Off {
  const Vector3d& point;
  double operator()(const joint::AxisTube& t) const {
    const Vector3d d = t.axis.direction.normalized();
    return std::abs((point - t.axis.point).cross(d).norm() - t.radius);
  }
  template <class Kind>
  double operator()(const Kind& kind) const {
    return std::abs(kind.solid().distance(point));
  }
};

/// Returns the link of two members that are joined only by a statement: the branch's end at the
/// chord.
joint::Link link(const FrameSpec& spec, const joint::NodeSpec& node, const StatedJoint& said) {
  const bool first = joint::detail::goes_before(node, said.member, said.with);
  const auto chord = first ? said.member : said.with, branch = first ? said.with : said.member;
  const auto& c = spec.members[chord];
  const auto& b = spec.members[branch];
  const auto off = [&](const Vector3d& p) {
    return joint::nearness(p, {c.start, c.finish, 0.0}).distance;
  };
  const auto nearer = off(b.start) <= off(b.finish) ? End::start : End::finish;
  return {.member = branch, .end = said.end.value_or(nearer), .to = {chord}};
}

/// Reads the stated joints, of members and of others.
Result<Joined> stated(const FrameSpec& spec) {
  Joined out;
  out.node.members = spec.members;
  out.others.resize(2 * spec.members.size());
  std::set<std::pair<std::size_t, std::size_t>> at_others;
  std::vector<joint::Link> links;
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    const auto& said = spec.joints[i];
    out.joints.push_back({said.member, said.with, said.other, said.how, i});
    if (said.other) {
      TRY(const auto end, detail::end_at(spec, i));
      const auto index = 2 * said.member + (end == End::finish ? 1 : 0);
      if (!at_others.emplace(index, said.with).second)
        return contradicts(i, {}, "this end's joint with it is stated already");
      out.others[index].push_back({said.with, i});
      continue;
    }
    if (!out.of_members.emplace(std::minmax(said.member, said.with), i).second)
      return contradicts(i, {}, "the joint of these two is stated already");
    out.node.joints.push_back({said.member, said.with, of_node(said.how), at_joint(i)});
    if (said.how.kind != How::Kind::through) links.push_back(link(spec, out.node, said));
  }
  if (spec.within)
    out.node.connect = joint::Within{*spec.within};
  else
    out.node.connect = std::move(links);
  return out;
}

/// Returns twice the sine of half the angle between two ends at a plane: as accurate as the angle.
double out_of_line(const joint::CutBy& cut) {
  return 2.0 * Vector3d::UnitZ().cross(cut.plane->normal.normalized()).norm();
}

/// Returns the joint by the defaults; in line, a butt joint or a mitre with their gap.
How found_as(const FrameSpec& spec, const joint::CutBy& cut) {
  if (!cut.plane) return spec.found;
  const bool square = out_of_line(cut) <= joint::kButtMost;
  return {.kind = square ? How::Kind::butt : How::Kind::mitre, .gap = spec.found.gap};
}

/// Adds the pairs that meet without a stated joint, each by its branch.
void add_found(const FrameSpec& spec, Joined& joined) {
  for (const auto& end : joined.nodes.ends)
    for (const auto& cut : end.cut_by) {
      const auto pair = std::minmax(end.member, cut.member);
      if (!joined.of_members.emplace(pair, joined.joints.size()).second) continue;
      const auto how = found_as(spec, cut);
      joined.joints.push_back({end.member, cut.member, false, how, std::nullopt});
      joined.node.joints.push_back({end.member, cut.member, of_node(how), "defaults"});
      ++joined.node.found;
    }
}

/// Checks that a butt joint joins two ends in line.
Result<void> check_butt(const joint::CutBy& cut, const Joint& one) {
  if (one.how.kind != How::Kind::butt || !one.stated) return {};
  const double off = out_of_line(cut);
  if (off <= joint::kButtMost) return {};
  return contradicts(*one.stated, "kind",
                     "the two lie " + brief(off * kDegPerRad) + " deg out of line; mitre them");
}

/// Takes the branch and the depth of set-in joints from the nodes.
Result<void> settle(const FrameSpec& spec, Joined& joined) {
  for (const auto& end : joined.nodes.ends)
    for (const auto& cut : end.cut_by) {
      auto& one = joined.joints[joined.joint_of(end.member, cut.member)];
      if (cut.plane) {
        TRY(check_butt(cut, one));
        continue;
      }
      one.branch = end.member;
      one.chord = cut.member;
      if (cut.stated) one.how.depth = cut.stated->depth;
    }
  for (auto& one : joined.joints) {
    if (one.how.kind != How::Kind::through) continue;
    const double a = spec.members[one.branch].half_size();
    const double b = spec.members[one.chord].half_size();
    if (a == b)
      return contradicts(*one.stated, "kind",
                         "of two equally thick neither passes through the other");
    if (a > b) std::swap(one.branch, one.chord);
  }
  return {};
}

std::vector<NotCut> not_cut(const FrameSpec& spec, const Joined& joined) {
  std::vector<NotCut> out;
  std::set<std::string> parallel;
  for (const auto& w : joined.nodes.warnings)
    if (w.code == WarningCode::parallel_members) parallel.insert(w.member);
  for (std::size_t i = 0; i < joined.nodes.ends.size(); ++i) {
    const auto& end = joined.nodes.ends[i];
    if (!end.cut_by.empty() || !joined.others[i].empty()) continue;
    const bool along = parallel.contains(joint::place_of(end.member, end.end));
    out.push_back({end.free ? Why::free
                   : along  ? Why::parallel
                            : Why::cuts_the_others,
                   end.member, end.end});
  }
  std::set<std::size_t> used;
  for (const auto& one : spec.joints)
    if (one.other) used.insert(one.with);
  for (std::size_t i = 0; i < spec.others.size(); ++i)
    if (!used.contains(i)) out.push_back({Why::not_joined, i, std::nullopt});
  return out;
}

/// Returns the warnings of the nodes, except those that an other body resolves: an end without
/// members, or open to them.
std::vector<Warning> warnings(const Joined& joined) {
  std::set<std::string> cut_by_others;
  for (std::size_t i = 0; i < joined.others.size(); ++i)
    if (!joined.others[i].empty())
      cut_by_others.insert(joint::place_of(joined.nodes.ends[i].member, joined.nodes.ends[i].end));
  std::vector<Warning> out;
  for (const auto& w : joint::once_a_pair(joined.node, joined.nodes)) {
    const bool good = w.code == WarningCode::free_end || w.code == WarningCode::end_open ||
                      w.code == WarningCode::parallel_members;
    if (!good || !cut_by_others.contains(w.member)) out.push_back(w);
  }
  return out;
}

std::vector<joint::Body> bodies(const FrameSpec& spec, const Joined& joined) {
  std::vector<joint::Body> out;
  for (const auto& other : spec.others) out.push_back({other.partner});
  for (std::size_t i = 0; i < joined.others.size(); ++i) {
    const auto& member = spec.members[i / 2];
    for (const auto& one : joined.others[i])
      out[one.other].joined.emplace_back(i / 2, i % 2 == 0 ? member.start : member.finish);
  }
  return out;
}

/// Warns of the members that enter one of the others although no joint names the two.
Result<std::vector<Warning>> warnings_of_others(const FrameSpec& spec, const Joined& joined,
                                                const joint::Beside& beside,
                                                const std::stop_token& stop) {
  TRY(const auto found,
      joint::overlaps_with(bodies(spec, joined), joined.node, joined.nodes, beside, stop));
  std::vector<Warning> out;
  for (const auto& o : found) {
    const auto& name = spec.others[o.body].name;
    out.push_back({.code = WarningCode::members_overlap,
                   .member = "members/" + std::to_string(o.member),
                   .detail = "it is up to " + brief(o.depth) + " mm deep in " +
                             (name.empty() ? at_other(o.body) : name) + ", at " + brief(o.at.x()) +
                             ", " + brief(o.at.y()) + ", " + brief(o.at.z()) +
                             " mm, and no joint names the two"});
  }
  return out;
}

}  // namespace

std::vector<std::size_t> round_holes(const std::vector<Hole>& holes) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < holes.size(); ++i)
    if (!holes[i].square) out.push_back(i);
  return out;
}

Result<End> detail::end_at(const FrameSpec& spec, std::size_t index) {
  const auto& said = spec.joints[index];
  if (said.end) return *said.end;
  const auto& m = spec.members[said.member];
  const auto& partner = spec.others[said.with].partner;
  const double start = joint::by_kind(partner, Off{m.start});
  const double finish = joint::by_kind(partner, Off{m.finish});
  if (std::abs(start - finish) > kEquallyNear) return start < finish ? End::start : End::finish;
  return fail({.code = ErrorCode::ambiguous_connection,
               .member = at_joint(index),
               .hint = "both ends are equally near; select one with end"});
}

Result<Frame> solve(const FrameSpec& spec, const std::stop_token& stop) {
  TRY(check_others(spec));
  TRY(auto joined, stated(spec));
  TRY(joined.nodes, joint::solve(joined.node, stop));
  const auto before = joined.joints.size();
  add_found(spec, joined);
  if (joined.joints.size() > before) {
    TRY(joined.nodes, joint::solve(joined.node, stop));
  }
  TRY(settle(spec, joined));
  Frame out;
  TRY(out.pieces, detail::pieces(spec, joined, stop));
  out.not_cut = not_cut(spec, joined);
  out.warnings = warnings(joined);
  const auto beside = detail::seats_of_others(spec, joined);
  TRY(const auto shared, joint::overlaps(joined.node, joined.nodes, {}, stop, beside));
  TRY(auto entering, warnings_of_others(spec, joined, beside, stop));
  for (auto& warning : joint::warnings_of(joined.node, shared))
    out.warnings.push_back(std::move(warning));
  for (auto& warning : entering) out.warnings.push_back(std::move(warning));
  out.joints = std::move(joined.joints);
  return out;
}

}  // namespace tubecut::frame
