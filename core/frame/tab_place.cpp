#include "core/frame/tab_place.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/joint/nearness.hpp"

namespace tubecut::frame {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using joint::End;

constexpr double kParallel = 1e-9;
constexpr double kDrawnOff = 1.0;  // mm, of an end from the body that it is drawn to
constexpr double kWritten = 1e6;   // requests state mm to 1e-6

/// Square to a round wall a beam follows a corner of this radius on the outside and no tighter one.
double round_corner(const RoundEntry& entry, bool along, double kerf) {
  const double stretch = along ? 1.0 : entry.wall.outer / entry.wall.inner;
  return std::ceil(0.5 * kerf * stretch * stretch * kWritten) / kWritten;
}

/// Returns true if the branch's stated or nearer end lies on the chord's axis or within its
/// outline.
bool ends_on(const joint::Member& branch, const joint::Member& chord,
             const std::optional<End>& stated) {
  const auto off = [&](End end) {
    return joint::nearness(branch.at(end), {chord.start, chord.finish, 0.0}).distance;
  };
  const double least = stated ? off(*stated) : std::min(off(End::start), off(End::finish));
  return least <= chord.reach() + kDrawnOff;
}

}  // namespace

std::size_t tabbed_member(const FrameSpec& spec, const StatedJoint& joint) {
  const auto &one = spec.members[joint.member], &other = spec.members[joint.with];
  const bool second = !ends_on(one, other, joint.end) && ends_on(other, one, joint.end);
  return second ? joint.with : joint.member;
}

WorldFace::WorldFace(const joint::Member& member, const Piece& piece, int face) {
  const Vector2d n = section::Curve::face_normal(face);
  const auto turned = piece.frame.rows.transpose();
  normal = turned * Vector3d(n.x(), n.y(), 0.0);
  round = turned * Vector3d(-n.y(), n.x(), 0.0);
  along = turned * Vector3d::UnitZ();
  point = piece.frame.origin + member.section->outer().face_distance(face) * normal;
}

WorldTab tab_in_world(const FrameSpec& spec, const Frame& frame, std::size_t branch, End end,
                      const StatedTab& stated) {
  const auto& member = spec.members[branch];
  const WorldFace face(member, frame.pieces[branch], stated.face);
  const double wall = member.section->wall;
  const Vector3d out = end == End::start ? Vector3d(-face.along) : face.along;
  return {face.point - 0.5 * wall * face.normal + stated.offset * face.round,
          {.axis = out, .face = face.normal, .width = stated.width, .thickness = wall}};
}

std::optional<RoundEntry> entry_of(const Piece& piece, const WorldTab& tab,
                                   const cutout::TabClearance& clearance) {
  const Vector3d axis = piece.frame.rows * tab.tab.axis;
  const double sine = axis.head<2>().norm();
  if (!(sine > kParallel)) return std::nullopt;
  const Vector2d out = -axis.head<2>() / sine, across(-out.y(), out.x());
  const double slide = axis.z() / sine;  // of z for each mm that the tab goes in
  // Places and sides, moved along the tab's axis to x = 0.
  const auto on_plane = [&](const Vector3d& v) -> Vector2d {
    return {across.dot(v.head<2>()), v.z() + out.dot(v.head<2>()) * slide};
  };
  const Vector3d face = piece.frame.rows * tab.tab.face;
  RoundEntry entry{.wall = {piece.target.outer_radius, piece.target.inner_radius()},
                   .phi = elementary::atan2(out.y(), out.x()),
                   .sine = sine};
  entry.tab = {.middle = on_plane(piece.frame.local(tab.middle)),
               .width = tab.tab.width * on_plane(face.cross(axis)),
               .thickness = tab.tab.thickness * on_plane(face),
               .lean = -slide};
  const double turn = elementary::asin(std::clamp(std::abs(across.dot(face.head<2>())), 0.0, 1.0));
  entry.across = turn < 0.25 * kPi;
  entry.askew = std::min(turn, 0.5 * kPi - turn);
  entry.clearance = entry.across ? Vector2d(clearance.width, clearance.thickness)
                                 : Vector2d(clearance.thickness, clearance.width);
  return entry;
}

double most_across(const RoundEntry& entry) {
  const double least = kLeastSine / entry.sine;
  return least < 1.0 ? entry.wall.inner * std::sqrt(1.0 - least * least) : 0.0;
}

FaceSlot slot_of(const RoundEntry& entry, bool along, double kerf) {
  const auto slot = cutout::slot_in_round(entry.tab, entry.wall, entry.clearance);
  FaceSlot out{.face = 0, .z = slot.z, .along = slot.along, .prism = along};
  // A prism is straight along the middle plane, which it holds in its middle.
  out.round = along ? 2.0 * std::max(-slot.low, slot.high) : slot.round;
  out.phi = entry.phi + (along ? 0.0 : slot.turn);
  out.phi -= kTwoPi * std::floor(out.phi / kTwoPi);
  out.corner = std::min(round_corner(entry, along, kerf), 0.5 * std::min(out.along, out.round));
  return out;
}

double tab_lacks(const RoundEntry& entry, const FaceSlot& slot) {
  cutout::RoundSlot there{.along = slot.along, .z = slot.z};
  there.turn = std::remainder(slot.phi - entry.phi, kTwoPi);
  there.round = slot.round;
  there.low = -0.5 * slot.round;
  there.high = 0.5 * slot.round;
  return cutout::tab_lacks(entry.tab, entry.wall, there,
                           slot.prism ? cutout::RoundCut::prism : cutout::RoundCut::square,
                           entry.clearance, slot.corner);
}

}  // namespace tubecut::frame
