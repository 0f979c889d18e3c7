#include "core/part/member.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/joint/node/overlap.hpp"
#include "core/joint/node/passing.hpp"
#include "core/joint/node/shape.hpp"
#include "core/math/rotation.hpp"
#include "core/part/edge.hpp"
#include "core/part/place.hpp"

namespace tubecut::part {
namespace {

constexpr double kAcross = 1e-12;  // of a direction: less runs along the tube

using Eigen::Vector3d;
using joint::AxisLine;
using joint::End;
using joint::MemberEnd;
using joint::MemberFrame;

/// Transforms a mitre's plane into another frame at the same end.
joint::PlaneCutter turned(const joint::PlaneCutter& plane, const MemberFrame& from,
                          const MemberFrame& to) {
  const Eigen::Matrix3d turn = to.rows * from.rows.transpose();
  return {turn * plane.point, turn * plane.normal};
}

/// Returns the partners of an end in `frame`.
Result<std::vector<joint::Partner>> partners(const joint::NodeSpec& node, const MemberEnd& end,
                                             const MemberFrame& frame) {
  std::vector<joint::Partner> out;
  const bool same = frame.rows == end.frame.rows;
  for (const auto& cut : end.cut_by) {
    if (cut.plane) {
      out.emplace_back(same ? *cut.plane : turned(*cut.plane, end.frame, frame));
      continue;
    }
    const auto& m = node.members[cut.member];
    if (cut.box) {
      auto box = same ? *cut.box : joint::box_of(m, frame);
      box.corner = cut.box->corner;  // sharp where two ends share it
      joint::straighten_as_drawn(box);
      out.emplace_back(box);
      continue;
    }
    TRY(const auto placed,
        same ? Result<joint::Placement>(cut.placement)
             : under("members/" + std::to_string(cut.member),
                     joint::place(frame.local(AxisLine{m.start, m.finish - m.start}),
                                  m.outer_radius)));
    out.emplace_back(placed.tube);
  }
  return out;
}

/// Computes the start and finish frames with one x: that of `up`, of the start's chord, or of the
/// finish's.
Result<std::pair<MemberFrame, MemberFrame>> frames(const joint::Member& m, const MemberEnd& start,
                                                   const MemberEnd& finish) {
  const bool from_start = m.up.has_value() || !start.cut_by.empty();
  const Vector3d x = (from_start ? start : finish).frame.rows.row(0);
  TRY(auto first,
      from_start ? Result<MemberFrame>(start.frame) : joint::member_frame(m.start, m.finish, x));
  TRY(auto last, m.up.has_value() ? Result<MemberFrame>(finish.frame)
                                  : joint::member_frame(m.finish, m.start, x));
  return std::pair{first, last};
}

/// The place where a line leaves an outline: s, and how far along the line.
struct Leaving {
  double s = 0.0, way = 0.0;
};
/// Returns where a line that leaves the square corner beyond a face's flat leaves the arc; one that
/// misses the arc counts as leaving it where it is nearest, so that the place does not jump.
Leaving leaving_corner(const section::Curve& outer, int corner, const AxisLine& line) {
  const Eigen::Vector2d d = line.direction.head<2>(), u = d.normalized();
  const Eigen::Vector2d from = line.point.head<2>() - outer.corner_centre(corner);
  const double along = from.dot(u), across = from.squaredNorm() - along * along;
  const double way = std::sqrt(std::max(0.0, outer.corner() * outer.corner() - across)) - along;
  const Eigen::Vector2d at = from + way * u, n = section::Curve::face_normal(corner);
  const double turn = elementary::atan2(n.x() * at.y() - n.y() * at.x(), n.dot(at));
  return {outer.on_corner(corner, std::clamp(turn, 0.0, 0.5 * kPi)), way / d.norm()};
}

}  // namespace

Mark mark_of(const joint::Member& branch, joint::End end, const MemberFrame& frame, double radius) {
  const AxisLine line = frame.local(AxisLine{branch.at(end), branch.into(end)});
  const Vector3d d = line.direction / line.direction.norm();
  const Vector3d& p = line.point;
  const double flat = d.x() * d.x() + d.y() * d.y();
  const double along = p.x() * d.x() + p.y() * d.y();
  const double outside = p.x() * p.x() + p.y() * p.y() - radius * radius;
  const double square = std::max(0.0, along * along - flat * outside);
  const Vector3d out = p + (std::sqrt(square) - along) / flat * d;
  return {Mark::Kind::partner, branch.name, math::whole_turn(elementary::atan2(out.y(), out.x())),
          out.z(), out.z()};
}

SectionMark mark_of(const joint::Member& branch, joint::End end, const MemberFrame& frame,
                    const section::Curve& outer) {
  const AxisLine line = frame.local(AxisLine{branch.at(end), branch.into(end)});
  const Vector3d d = line.direction.normalized();
  // The line leaves a rectangle by the face that it reaches first of those that it runs towards.
  double way = std::numeric_limits<double>::infinity();
  int out = 1;
  for (int face = 1; face <= 4; ++face) {
    const Eigen::Vector2d n = section::Curve::face_normal(face);
    const double towards = n.dot(d.head<2>());
    if (!(towards > kAcross)) continue;
    const double there =
        std::max(0.0, (outer.face_distance(face) - n.dot(line.point.head<2>())) / towards);
    if (!(there < way)) continue;
    way = there;
    out = face;
  }
  if (!std::isfinite(way)) way = 0.0;
  const Eigen::Vector2d n = section::Curve::face_normal(out), t(-n.y(), n.x());
  const double along = t.dot((line.point + way * d).head<2>()), half = outer.half_flat(out);
  Leaving at{outer.on_face(out, std::clamp(along, -half, half)), way};
  if (std::abs(along) > half && outer.corner() > 0.0 && d.head<2>().norm() > kAcross)
    at = leaving_corner(outer, along > 0.0 ? out : (out + 2) % 4 + 1, {line.point, d});
  const double z = line.point.z() + at.way * d.z();
  return {Mark::Kind::partner, branch.name, at.s, z, z};
}

cutout::Branch square_branch(const joint::Member& branch, joint::End end, const MemberFrame& frame,
                             joint::JointKind kind, double gap) {
  return {.section = branch.section,
          .radius = branch.outer_radius,
          .wall = branch.wall,
          .axis = frame.local(AxisLine{branch.at(end), branch.into(end)}),
          .up = frame.rows * branch.up.value_or(Vector3d::UnitZ()),
          .kind = kind,
          .gap = gap};
}

namespace {

bool cut_by(const MemberEnd& end, std::size_t member) {
  return std::ranges::any_of(end.cut_by,
                             [&](const auto& c) { return c.member == member && !c.plane; });
}

struct Standing {
  std::size_t member;
  End end;
};

/// Finds the ends of other members that this one cuts.
std::vector<Standing> standing_on(const joint::Nodes& nodes, std::size_t member) {
  std::vector<Standing> out;
  for (const auto& end : nodes.ends)
    if (cut_by(end, member)) out.push_back({end.member, end.end});
  return out;
}

bevel::HoleSpec hole_for(bevel::HoleSpec hole, const joint::Target& chord,
                         const joint::Member& branch, End end, const MemberFrame& frame) {
  hole.chord = chord;
  hole.chord.length.reset();
  hole.branch = joint::AxisTube{.radius = branch.outer_radius,
                                .axis = frame.local(AxisLine{branch.at(end), branch.into(end)})};
  hole.branch_wall = branch.wall;
  return hole;
}

Result<void> add_holes(const MemberSpec& spec, const joint::NodeSpec& node,
                       const std::vector<Standing>& standing, const MemberFrame& frame,
                       PartSpec& out) {
  const bool round = !node.members[spec.member].section;
  for (std::size_t i = 0; i < spec.holes.size(); ++i) {
    const auto& [cut, member] = spec.holes[i];
    const auto& branch = node.members[member];
    const auto add = [&](End end) {
      if (round && !branch.section)
        out.holes.push_back({hole_for(cut, out.target, branch, end, frame), branch.name, i});
      else
        out.square_holes.push_back(
            {square_branch(branch, end, frame, cut.kind, cut.gap), branch.name, i});
    };
    const bool through = cut.kind == bevel::JointKind::through;
    const auto before = out.holes.size() + out.square_holes.size();
    if (through && member != spec.member) {
      TRY(joint::check_passes({branch, branch.name}, {node.members[spec.member], "the part"},
                              "holes/" + std::to_string(i) + "/member"));
      add(End::start);
    }
    for (const auto& one : standing)
      if (!through && one.member == member) add(one.end);
    if (out.holes.size() + out.square_holes.size() == before)
      return fail({.code = ErrorCode::no_contact,
                   .member = "holes/" + std::to_string(i) + "/member",
                   .got = branch.name,
                   .hint = "no end of this member is cut by the part"});
  }
  return {};
}

bool is_hole_for(const bevel::HoleSpec& hole, const joint::Joint& joint) {
  return hole.kind == joint.kind && hole.gap == joint.gap && hole.depth == joint.depth;
}

/// Checks the requested joints against those of the members, because chord and branch are separate
/// requests and the branch is cut by the members' joints.
Result<void> check_joints(const MemberSpec& spec, const std::vector<Standing>& standing,
                          std::vector<Warning>& warnings) {
  for (std::size_t i = 0; i < spec.holes.size(); ++i) {
    const auto& [cut, branch] = spec.holes[i];
    const auto* stated = joint::stated_joint(spec.node, spec.member, branch);
    const auto at = "holes/" + std::to_string(i) + "/joint";
    const auto& name = spec.node.members[branch].name;
    if (stated != nullptr && !is_hole_for(cut, *stated))
      return fail({.code = ErrorCode::joint_contradicts,
                   .member = at,
                   .hint = "the members state this joint otherwise; leave joint out here"});
    const bool ends_here =
        std::ranges::any_of(standing, [&](const Standing& one) { return one.member == branch; });
    if (stated == nullptr && ends_here && !is_hole_for(cut, {}))
      warnings.push_back({.code = WarningCode::joint_not_stated,
                          .member = at,
                          .detail = "from these members " + name +
                                    "'s own end is cut to be set on without a gap; state the joint "
                                    "on either member"});
  }
  return {};
}

/// Warns of branches that enter the wall by their stated joint without a requested hole.
void warn_of_missing(const MemberSpec& spec, const std::vector<Standing>& standing,
                     std::vector<Warning>& warnings) {
  const auto& members = spec.node.members;
  std::set<std::size_t> branches;
  for (const auto& said : spec.node.joints) {
    if (said.member != spec.member && said.with != spec.member) continue;
    const auto other = said.member == spec.member ? said.with : said.member;
    const bool enters =
        said.joint.kind == bevel::JointKind::through
            ? joint::which_passes(members[other], members[spec.member]) == joint::Passing::first
            : said.joint.kind == bevel::JointKind::set_in &&
                  std::ranges::any_of(standing, [&](const auto& s) { return s.member == other; });
    const bool asked =
        std::ranges::any_of(spec.holes, [&](const auto& h) { return h.branch == other; });
    if (enters && !asked) branches.insert(other);
  }
  for (const auto branch : branches)
    warnings.push_back({.code = WarningCode::hole_missing,
                        .member = "members/" + std::to_string(branch),
                        .detail = members[branch].name + " enters this part's wall"});
}

EndSpec end_spec(const MemberSpec& spec, const joint::Target& target,
                 std::vector<joint::Partner> partners, const MemberEnd& end) {
  auto cut = spec.cut;
  cut.target = target;
  if (partners.empty()) return square_end(cut, 0.0);
  cut.partners = std::move(partners);
  for (const auto& one : end.cut_by) cut.stated.push_back(one.stated);
  return {.cut = std::move(cut)};
}

std::vector<std::size_t> members_of(const MemberEnd& end) {
  std::vector<std::size_t> out;
  for (const auto& cut : end.cut_by) out.push_back(cut.member);
  return out;
}

std::vector<Warning> about(const joint::Nodes& nodes, std::size_t member) {
  std::vector<Warning> out;
  const auto at = "members/" + std::to_string(member) + "/";
  for (const auto& w : nodes.warnings)
    if (w.member.starts_with(at) && w.code != WarningCode::near_parallel) out.push_back(w);
  return out;
}

}  // namespace

Result<Angle> datum_angle(Datum datum, Angle seam, const std::vector<joint::Partner>& start,
                          const std::vector<joint::Partner>& finish) {
  if (datum == Datum::up) return Angle{};
  if (datum == Datum::seam) return seam;
  if (!start.empty())
    if (const auto side = bearing(start.front())) return Angle::rad(side->perpendicular);
  if (!finish.empty())
    if (const auto side = bearing(finish.front())) return Angle::rad(-side->perpendicular);
  return fail({.code = ErrorCode::bad_reference_direction,
               .member = "datum",
               .got = "first_cutter",
               .limit = "up|seam",
               .unit = {},
               .hint = "no partner defines a direction"});
}

EndSpec square_end(const bevel::TableSpec& options, double height) {
  EndSpec out{.cut = {.target = options.target, .sampling = options.sampling}, .welded = false};
  out.cut.partners = {joint::PlaneCutter{.point = {0.0, 0.0, height}}};
  out.cut.groove = bevel::SquareCut{};
  out.cut.kerf = options.kerf;
  out.cut.torch = options.torch;
  out.cut.smoothing = bevel::NoSmoothing{};
  return out;
}

Result<FoundMember> find_member(const MemberSpec& spec) {
  auto node = spec.node;
  auto& m = node.members.at(spec.member);
  if (spec.up) m.up = spec.up;
  const auto nodes = joint::solve(node);
  if (!nodes) {
    auto error = nodes.error();
    const auto own = "members/" + std::to_string(spec.member) + "/up";
    for (auto& issue : error.issues)
      if (spec.up && issue.member == own) issue.member = "up";
    return tl::unexpected(std::move(error));
  }
  const auto& start = nodes->ends[2 * spec.member];
  const auto& finish = nodes->ends[2 * spec.member + 1];
  TRY(const auto both, frames(m, start, finish));
  auto at_start = partners(node, start, both.first);
  auto at_finish = partners(node, finish, both.second);
  if (!at_start) return tl::unexpected(at_start.error());
  if (!at_finish) return tl::unexpected(at_finish.error());
  auto zero = datum_angle(spec.datum, Angle{}, *at_start, *at_finish);
  if (!zero) return tl::unexpected(zero.error());
  if (spec.datum == Datum::seam) zero = *zero + spec.seam;
  FoundMember out;
  auto& part = out.part;
  part.target = {
      .outer_radius = m.half_size(), .wall = m.thickness(), .length = (m.finish - m.start).norm()};
  part.zero = *zero;
  part.start_frame = both.first;
  part.name = m.name;
  part.start = end_spec(spec, part.target, *std::move(at_start), start);
  part.finish = end_spec(spec, part.target, *std::move(at_finish), finish);
  const auto standing = standing_on(*nodes, spec.member);
  for (const auto& one : standing) {
    const auto& branch = node.members[one.member];
    if (m.section)
      out.on_faces.push_back(mark_of(branch, one.end, both.first, m.section->outer()));
    else
      part.partners.push_back(mark_of(branch, one.end, both.first, m.outer_radius));
  }
  TRY(check_joints(spec, standing, out.warnings));
  warn_of_missing(spec, standing, out.warnings);
  TRY(add_holes(spec, node, standing, both.first, part));
  part.clamping = spec.clamping;
  part.facing = spec.facing;
  part.density = spec.density;
  out.start_cutters = members_of(start);
  out.finish_cutters = members_of(finish);
  for (auto& warning : about(*nodes, spec.member)) out.warnings.push_back(std::move(warning));
  TRY(const auto shared, joint::overlaps(node, *nodes, spec.member));
  for (auto& warning : joint::warnings_of(node, shared, spec.member))
    out.warnings.push_back(std::move(warning));
  return out;
}

}  // namespace tubecut::part
