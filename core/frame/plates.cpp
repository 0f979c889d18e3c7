#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/frame/frame_parts.hpp"
#include "core/joint/finished.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/plate/metal.hpp"
#include "core/plate/web.hpp"

namespace tubecut::frame::detail {
namespace {

using cutout::Flat;
using Eigen::Vector3d;
using joint::End;
using joint::MemberFrame;

constexpr double kSameDistance = 1e-6;  // mm
constexpr double kSlight = 0.1;  // mm: a wall that reaches beyond the outline by less does not
constexpr int kGeneratorsOfWall = 96;  // that are compared with a plate
constexpr int kPlacesOfGenerator = 33;
constexpr int kPlacesOfSegment = 16;  // of an outline

std::string joint_path(std::size_t i) { return "joints/" + std::to_string(i); }
std::string plate_path(std::size_t i) { return "plates/" + std::to_string(i); }

/// Returns a plane parallel to the plate that keeps the side of the member.
joint::PlaneCutter plane_at(const MemberFrame& plate, double height, bool front) {
  const Vector3d n = plate.rows.row(2);
  return {plate.origin + height * n, front ? n : Vector3d(-n)};
}

/// Heights of a member's ends over a plate's face.
struct Heights {
  double start, finish;
  [[nodiscard]] double at(End end) const { return end == End::start ? start : finish; }
};

Result<End> end_of_joint(const FrameSpec& spec, std::size_t index, const Heights& heights) {
  const auto& said = spec.joints[index];
  if (said.end) return *said.end;
  const double middle = -0.5 * spec.plates[said.with].thickness;
  const double start = std::abs(heights.start - middle);
  const double finish = std::abs(heights.finish - middle);
  if (std::abs(start - finish) > kSameDistance) return start < finish ? End::start : End::finish;
  return fail({.code = ErrorCode::ambiguous_connection,
               .member = joint_path(index),
               .hint = "both ends are equally near; select one with end"});
}

/// Returns how far an end is outside of the plate, along the member's axis.
EndOff off_plate(double height, double thickness, double slope) {
  const double outside = std::max({height, -thickness - height, 0.0});
  return {.distance = outside > 0.0 ? outside / std::abs(slope) : 0.0,
          .what = "the plate",
          .instead = ", or, if the member passes the plate, use through"};
}

/// A member that passes through reaches beyond both faces.
Result<AtPlate> passing_through(std::size_t index, const Heights& heights, double thickness) {
  const auto [low, high] = std::minmax(heights.start, heights.finish);
  const double short_by = std::max(-high, low + thickness);
  if (short_by <= kSameDistance) return AtPlate{.from = 0.0, .to = -thickness};
  return fail({.code = ErrorCode::no_contact,
               .member = joint_path(index),
               .got = short_by,
               .limit = 0.0,
               .unit = "mm",
               .hint = "a member that passes through reaches beyond both faces of the plate; if it "
                       "ends there, use set_in or set_on"});
}

/// Returns true if a place of the outline lies on the plate, and false if none does.
bool touches(const cutout::Chain& outline, const cutout::Chain& plate) {
  if (plate::encloses(outline, plate.front().from)) return true;
  return std::ranges::any_of(
      outline, [&](const cutout::Segment& s) { return plate::encloses(plate, s.from); });
}

Result<void> add_stood(const FrameSpec& spec, const Joined& joined, std::size_t index,
                       FramePlate& out) {
  const auto& one = joined.joints[index];
  TRY(const auto at, at_plate(spec, *one.stated));
  const double height = at.front ? 0.0 : -spec.plates[one.chord].thickness;
  TRY(auto outline, under(joint_path(*one.stated),
                          plate::outline_at(spec.members[one.branch], height, out.plate.frame)));
  if (!touches(outline, out.plate.outline) && plate::gap(outline, out.plate.outline) > 0.0)
    return fail({.code = ErrorCode::no_contact,
                 .member = joint_path(*one.stated),
                 .got = plate::gap(outline, out.plate.outline),
                 .limit = 0.0,
                 .unit = "mm",
                 .hint = "the member meets the plane of the plate outside its outline"});
  for (const auto& hole : out.plate.holes)
    if (plate::encloses(hole.chain, outline.front().from) && plate::gap(hole.chain, outline) > 0.0)
      return fail({.code = ErrorCode::no_contact,
                   .member = joint_path(*one.stated),
                   .hint = "the member lies within opening " + hole.name + " of " +
                           spec.plates[one.chord].name + " and touches no metal"});
  out.stood.push_back({one.branch, index, at.front, std::move(outline)});
  return {};
}

/// Errors of a plate point to it, those of its tubes to their joints.
Error of_plate(std::size_t index, Error error) {
  for (auto& issue : error.issues)
    if (!issue.member.starts_with("joints/"))
      issue.member = plate_path(index) + (issue.member.empty() ? "" : "/") + issue.member;
  return error;
}

Result<FramePlate> one_plate(const FrameSpec& spec, const Joined& joined, std::size_t index) {
  FramePlate out;
  const auto on_it = [&](const FrameJoint& one) { return one.plate && one.chord == index; };
  for (std::size_t i = 0; i < joined.joints.size(); ++i) {
    const auto& one = joined.joints[i];
    if (!on_it(one) || one.how.kind == How::Kind::set_on) continue;
    TRY(const auto at, at_plate(spec, *one.stated));
    const auto& tube = spec.members[one.branch];
    out.passing.push_back({.passage = {tube, at.from, at.to, one.how.gap},
                           .name = tube.name,
                           .at = joint_path(*one.stated)});
    out.joints.push_back(i);
  }
  auto made = plate::make(spec.plates[index], out.passing);
  if (!made) return tl::unexpected(of_plate(index, std::move(made).error()));
  out.plate = *std::move(made);
  for (std::size_t i = 0; i < joined.joints.size(); ++i)
    if (on_it(joined.joints[i]) && joined.joints[i].how.kind == How::Kind::set_on)
      TRY(add_stood(spec, joined, i, out));
  return out;
}

struct Deep {
  double depth = 0.0;
  Vector3d at = Vector3d::Zero();  // in the plate's frame
};

/// Returns the deepest place of a finished member's wall in a plate, over generators outside and on
/// the bore.
Deep deepest(const joint::detail::Finished& m, const plate::Plate& plate, double thickness) {
  Deep out;
  const plate::Metal metal(plate, thickness);
  const Vector3d along = plate.frame.rows * m.axis;
  for (const double rho : {m.outer, m.inner})
    for (int k = 0; k < kGeneratorsOfWall; ++k) {
      const auto line = m.line(kTwoPi * k / kGeneratorsOfWall, rho);
      auto span = m.span(line.rho, line.q);
      const Vector3d foot = plate.frame.local(m.point(line, 0.0));
      if (along.z() != 0.0) {
        const auto [a, b] =
            std::minmax({-foot.z() / along.z(), (-thickness - foot.z()) / along.z()});
        span.from = std::max(span.from, a);
        span.to = std::min(span.to, b);
      } else if (foot.z() >= 0.0 || foot.z() <= -thickness) {
        continue;
      }
      for (int i = 0; i < kPlacesOfGenerator && span.from < span.to; ++i) {
        const double share = static_cast<double>(i) / (kPlacesOfGenerator - 1);
        const Vector3d p = foot + (span.from + share * (span.to - span.from)) * along;
        if (const double depth = metal.depth(p); depth > out.depth) out = {depth, p};
      }
    }
  return out;
}

/// Returns true if the member may enter the plate, from its axis alone.
bool may_enter(const joint::Member& m, const plate::Plate& plate, double thickness) {
  const auto box = cutout::bounds(plate.outline);
  const Vector3d a = plate.frame.local(m.start), b = plate.frame.local(m.finish);
  const Vector3d low = a.cwiseMin(b).array() - m.reach(), high = a.cwiseMax(b).array() + m.reach();
  return low.x() < box.most.x() && high.x() > box.least.x() && low.y() < box.most.y() &&
         high.y() > box.least.y() && low.z() < 0.0 && high.z() > -thickness;
}

/// Warns of plates that overlap, at the earlier one.
Result<void> add_shared(const FrameSpec& spec, const std::vector<FramePlate>& plates,
                        std::vector<Warning>& out) {
  std::vector<plate::Metal> metal;
  for (std::size_t k = 0; k < plates.size(); ++k)
    metal.emplace_back(plates[k].plate, spec.plates[k].thickness);
  std::size_t found = 0;
  for (std::size_t a = 0; a < metal.size(); ++a)
    for (std::size_t b = a + 1; b < metal.size(); ++b) {
      if (stopped()) return fail({.code = ErrorCode::cancelled});
      const auto shared = plate::shared_metal(metal[a], metal[b]);
      if (!shared) continue;
      out.push_back({.code = WarningCode::members_overlap,
                     .member = plate_path(a),
                     .detail = "it and " + spec.plates[b].name + " share metal, up to " +
                               brief(shared->depth) + " mm deep, at " + brief(shared->at.x()) +
                               ", " + brief(shared->at.y()) + ", " + brief(shared->at.z()) +
                               " mm"});
      if (++found > joint::kMostOverlaps) return joint::too_many_overlaps(found);
    }
  return {};
}

/// Returns how far an outline reaches beyond the plate's.
double overhang(const cutout::Chain& outline, const cutout::Chain& plate) {
  double out = 0.0;
  for (const auto& s : outline)
    for (int k = 0; k < kPlacesOfSegment; ++k)
      if (const Flat p = s.at(static_cast<double>(k) / kPlacesOfSegment);
          !plate::encloses(plate, p))
        out = std::max(out, cutout::distance(plate, p));
  return out;
}

/// Returns how wide the part of a wall is that stands over an opening, mm: over its border, or
/// nearer to it than the wall is thick.
double over_opening(const cutout::Chain& outline, double wall, const cutout::Chain& hole) {
  const double off = plate::gap(hole, outline);
  const bool within = plate::encloses(outline, hole.front().from);
  return off == 0.0 || within ? wall - off : 0.0;
}

}  // namespace

joint::Partner partner_of(const FrameSpec& spec, const OtherAt& one) {
  return one.plate ? joint::Partner(one.face) : spec.others[one.other].partner;
}

std::string path_of(const OtherAt& one) {
  return (one.plate ? "plates/" : "others/") + std::to_string(one.other);
}

double gap_of(const FrameJoint& joint) {
  return joint.plate && joint.how.kind == How::Kind::set_in ? 0.0 : joint.how.gap;
}

Result<AtPlate> at_plate(const FrameSpec& spec, std::size_t index) {
  const auto& said = spec.joints[index];
  const auto& plate = spec.plates[said.with];
  const auto& m = spec.members[said.member];
  TRY(const auto frame, under(plate_path(said.with), plate::frame_of(plate)));
  const Heights heights{frame.local(m.start).z(), frame.local(m.finish).z()};
  const double thickness = plate.thickness;
  if (said.how.kind == How::Kind::through) return passing_through(index, heights, thickness);
  AtPlate out;
  TRY(out.end, end_of_joint(spec, index, heights));
  const double far = heights.at(out.end == End::start ? End::finish : End::start);
  out.front = far > 0.0;
  if (!out.front && !(far < -thickness))
    return fail({.code = ErrorCode::ambiguous_connection,
                 .member = joint_path(index),
                 .hint = "the member's other end lies between the faces of the plate, so it is not "
                         "known which face it is set on"});
  const Vector3d axis = (m.finish - m.start).normalized();
  TRY(check_near(index, m, off_plate(heights.at(out.end), thickness, axis.dot(frame.rows.row(2)))));
  if (said.how.kind == How::Kind::set_on) {
    out.face = plane_at(frame, out.front ? 0.0 : -thickness, out.front);
    return out;
  }
  out.depth = said.how.depth.value_or(thickness);
  if (out.depth > thickness)
    return fail({.code = ErrorCode::out_of_range,
                 .member = joint_path(index) + "/depth",
                 .got = out.depth,
                 .limit = thickness,
                 .unit = "mm",
                 .hint = "at most the plate's thickness"});
  out.from = out.front ? 0.0 : out.depth - thickness;
  out.to = out.from - out.depth;
  out.face = plane_at(frame, out.front ? out.to : out.from, out.front);
  return out;
}

Result<std::vector<FramePlate>> plates(const FrameSpec& spec, const Joined& joined) {
  std::vector<FramePlate> out;
  std::vector<Issue> issues;
  for (std::size_t i = 0; i < spec.plates.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    auto one = one_plate(spec, joined, i);
    if (one)
      out.push_back(*std::move(one));
    else
      for (auto& issue : one.error().issues) issues.push_back(std::move(issue));
  }
  TRY(no_issues(std::move(issues)));
  return out;
}

Result<std::vector<Warning>> warnings_of_plates(const FrameSpec& spec, const Joined& joined,
                                                const std::vector<FramePlate>& plates,
                                                const joint::Beside& beside) {
  std::vector<Warning> out;
  for (std::size_t k = 0; k < plates.size(); ++k) {
    const auto& plate = plates[k].plate;
    const double thickness = spec.plates[k].thickness;
    std::vector<bool> joined_to(spec.members.size(), false);
    for (const auto& one : joined.joints)
      if (one.plate && one.chord == k) joined_to[one.branch] = true;
    for (const auto& one : plates[k].stood)
      if (const double by = overhang(one.outline, plate.outline); by > kSlight) {
        TRY(const auto at, at_plate(spec, *joined.joints[one.joint].stated));
        out.push_back(
            {.code = WarningCode::wall_overhangs,
             .member = joint::place_of(one.member, at.end),
             .detail = "up to " + brief(by) + " mm beyond the outline of " + spec.plates[k].name});
      }
    for (const auto& one : plates[k].stood)
      for (const auto& hole : plate.holes) {
        const double over =
            over_opening(one.outline, spec.members[one.member].thickness(), hole.chain);
        if (!(over > kSlight)) continue;
        TRY(const auto at, at_plate(spec, *joined.joints[one.joint].stated));
        out.push_back({.code = WarningCode::wall_overhangs,
                       .member = joint::place_of(one.member, at.end),
                       .detail = "up to " + brief(over) + " mm of the wall lie over opening " +
                                 hole.name + " of " + spec.plates[k].name});
      }
    for (std::size_t i = 0; i < spec.members.size(); ++i) {
      if (stopped()) return fail({.code = ErrorCode::cancelled});
      if (joined_to[i] || !may_enter(spec.members[i], plate, thickness)) continue;
      const auto member = joint::detail::finished(joined.node, joined.nodes, i, beside);
      const auto deep = deepest(member, plate, thickness);
      if (!(deep.depth > joint::detail::kLeastShared)) continue;
      const Vector3d at = plate.frame.origin + plate.frame.rows.transpose() * deep.at;
      out.push_back({.code = WarningCode::members_overlap,
                     .member = "members/" + std::to_string(i),
                     .detail = "it is up to " + brief(deep.depth) + " mm deep in " +
                               spec.plates[k].name + ", at " + brief(at.x()) + ", " +
                               brief(at.y()) + ", " + brief(at.z()) +
                               " mm, and no joint names the two"});
    }
  }
  TRY(add_shared(spec, plates, out));
  return out;
}

}  // namespace tubecut::frame::detail
