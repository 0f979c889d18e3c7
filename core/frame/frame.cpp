#include "core/frame/frame.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/frame/frame_parts.hpp"
#include "core/frame/tab_slots.hpp"
#include "core/joint/nearness.hpp"
#include "core/joint/node/body_overlap.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/overlap.hpp"
#include "core/joint/node/passing.hpp"

namespace tubecut::frame {
namespace {

using detail::Joined;
using Eigen::Vector3d;
using joint::End;

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
    case How::Kind::tab_slot:
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

joint::Nearness near(const joint::Member& branch, End end, const joint::Member& chord) {
  return joint::nearness(branch.at(end), {chord.start, chord.finish, 0.0});
}
End nearer_end(const joint::Member& branch, const joint::Member& chord) {
  const bool first =
      near(branch, End::start, chord).distance <= near(branch, End::finish, chord).distance;
  return first ? End::start : End::finish;
}
/// Returns true if the branch ends between the chord's ends, as a rail on a post does, and is not
/// too wide for it.
bool ends_between(const joint::Member& branch, const joint::Member& chord) {
  const auto end = nearer_end(branch, chord);
  return joint::detail::runs_past(chord, branch, end, near(branch, end, chord).inside, 0.0);
}

/// Returns the link of two members that are joined only by a statement: the branch's end at the
/// chord. Of two alike, the one is the branch that ends between the ends of the other.
Result<joint::Link> link(const FrameSpec& spec, const joint::NodeSpec& node, std::size_t index) {
  const auto& said = spec.joints[index];
  const bool first = joint::detail::goes_before(node, said.member, said.with);
  auto chord = first ? said.member : said.with, branch = first ? said.with : said.member;
  const auto& a = spec.members[chord];
  const auto& z = spec.members[branch];
  if (ends_between(a, z) && !ends_between(z, a)) std::swap(chord, branch);
  if (said.how.kind == How::Kind::tab_slot) {
    branch = tabbed_member(spec, said);
    chord = branch == said.member ? said.with : said.member;
  }
  const auto& c = spec.members[chord];
  const auto& b = spec.members[branch];
  const auto end = said.end.value_or(nearer_end(b, c));
  const double most = joint::detail::far_end(b, c), off = near(b, end, c).distance;
  if (off > most && said.how.kind != How::Kind::mitre && said.how.kind != How::Kind::butt)
    return fail(
        {.code = ErrorCode::no_contact,
         .member = at_joint(index),
         .got = off,
         .limit = most,
         .unit = "mm",
         .hint = "the " + std::string(name_of(end)) + " of " + joint::detail::called(node, branch) +
                 ", the branch, is too far from " + joint::detail::called(node, chord) +
                 "; if the other is the branch, give " + joint::detail::called(node, branch) +
                 " the lower priority number; if they cross, join them by through"});
  return joint::Link{.member = branch, .end = end, .to = {chord}};
}

/// Adds the stated joint of a member with a plate.
Result<void> add_plate(const FrameSpec& spec, std::size_t index, Joined& out,
                       std::set<std::pair<std::size_t, std::size_t>>& known) {
  const auto& said = spec.joints[index];
  const bool through = said.how.kind == How::Kind::through;
  TRY(const auto at, detail::at_plate(spec, index));
  // A member may pass a plate once, or have one end at it.
  if (!known.emplace(said.member, said.with).second)
    return contradicts(index, {}, "the joint of this member and this plate is stated already");
  auto& how = out.joints.back().how;
  how.hole = how.kind != How::Kind::set_on;
  if (how.kind == How::Kind::set_in) how.depth = at.depth;
  if (through) return {};
  out.others[joint::end_index(said.member, at.end)].push_back(
      {.other = said.with, .joint = index, .plate = true, .face = at.face});
  return {};
}

/// Reads the stated joints, of members, of others and of plates.
Result<Joined> stated(const FrameSpec& spec) {
  Joined out;
  out.node.members = spec.members;
  out.others.resize(2 * spec.members.size());
  std::set<std::pair<std::size_t, std::size_t>> at_others, at_plates;
  std::vector<joint::Link> links;
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    const auto& said = spec.joints[i];
    out.joints.push_back({said.member, said.with, said.other, said.how, i, said.plate});
    if (said.plate) {
      TRY(add_plate(spec, i, out, at_plates));
      continue;
    }
    if (said.other) {
      TRY(const auto end, detail::end_at(spec, i));
      TRY(detail::check_near_other(spec, i, end));
      const auto index = 2 * said.member + (end == End::finish ? 1 : 0);
      if (!at_others.emplace(index, said.with).second)
        return contradicts(i, {}, "this end's joint with it is stated already");
      out.others[index].push_back({said.with, i});
      continue;
    }
    if (!out.of_members.emplace(std::minmax(said.member, said.with), i).second)
      return contradicts(i, {}, "the joint of these two is stated already");
    out.node.joints.push_back({said.member, said.with, of_node(said.how), at_joint(i)});
    if (spec.within || said.how.kind == How::Kind::through) continue;
    TRY(links.emplace_back(), link(spec, out.node, i));
  }
  if (spec.within)
    out.node.connect = joint::Within{*spec.within};
  else
    out.node.connect = std::move(links);
  return out;
}

/// Returns the angle between two ends at a plane that halves it, rad.
double out_of_line(const joint::CutBy& cut) {
  return 2.0 * elementary::asin(
                   std::min(1.0, Vector3d::UnitZ().cross(cut.plane->normal.normalized()).norm()));
}

/// Returns the joint by the defaults; in line, a butt joint or a mitre with their gap.
How found_as(const FrameSpec& spec, const joint::CutBy& cut) {
  if (!cut.plane) return spec.found;
  const bool square = out_of_line(cut) <= joint::kButtMost;
  return {.kind = square ? How::Kind::butt : How::Kind::mitre, .gap = spec.found.gap};
}

/// Drops found cutters that others hide everywhere: two rails that meet at a post end on its faces,
/// and a joint of the two would make them different parts.
void drop_hidden(Joined& joined) {
  for (auto& end : joined.nodes.ends) {
    const auto touched = joint::cuts_anywhere(joined.node.members[end.member], end);
    const auto hidden = [&](const joint::CutBy& cut) {
      const auto index = static_cast<std::size_t>(&cut - end.cut_by.data());
      const auto known = joined.of_members.find(std::minmax(end.member, cut.member));
      const bool stated =
          known != joined.of_members.end() && joined.joints[known->second].stated.has_value();
      return !touched[index] && !stated && !cut.plane;
    };
    std::vector<joint::CutBy> kept;
    for (const auto& cut : end.cut_by)
      if (!hidden(cut)) kept.push_back(cut);
    end.cut_by = std::move(kept);
  }
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
Result<void> check_butt(const joint::CutBy& cut, const FrameJoint& one) {
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
    if (one.how.kind != How::Kind::through || one.plate) continue;
    const auto passing = joint::which_passes(spec.members[one.branch], spec.members[one.chord]);
    if (passing == joint::Passing::second) std::swap(one.branch, one.chord);
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
      if (!one.plate)
        out[one.other].joined.emplace_back(i / 2, i % 2 == 0 ? member.start : member.finish);
  }
  return out;
}

/// Warns of the members that enter one of the others although no joint names the two.
Result<std::vector<Warning>> warnings_of_others(const FrameSpec& spec, const Joined& joined,
                                                const joint::Beside& beside) {
  TRY(const auto found,
      joint::overlaps_with(bodies(spec, joined), joined.node, joined.nodes, beside));
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

Result<Frame> solve(const FrameSpec& spec) {
  TRY(check_others(spec));
  TRY(auto joined, stated(spec));
  // A found joint that is set in moves its cut, so that another cutter may no longer be hidden.
  for (std::size_t before = joined.joints.size() + 1; before != joined.joints.size();) {
    TRY(joined.nodes, joint::solve(joined.node));
    drop_hidden(joined);
    before = joined.joints.size();
    add_found(spec, joined);
  }
  TRY(settle(spec, joined));
  Frame out;
  TRY(out.plates, detail::plates(spec, joined));
  TRY(out.pieces, detail::pieces(spec, joined));
  out.not_cut = not_cut(spec, joined);
  out.warnings = warnings(joined);
  const auto beside = detail::seats_of_others(spec, joined);
  TRY(const auto shared, joint::overlaps(joined.node, joined.nodes, {}, beside));
  TRY(auto entering, warnings_of_others(spec, joined, beside));
  for (auto& warning : joint::warnings_of(joined.node, shared))
    out.warnings.push_back(std::move(warning));
  for (auto& warning : entering) out.warnings.push_back(std::move(warning));
  TRY(auto of_plates, detail::warnings_of_plates(spec, joined, out.plates, beside));
  for (auto& warning : of_plates) out.warnings.push_back(std::move(warning));
  out.joints = std::move(joined.joints);
  return out;
}

}  // namespace tubecut::frame
