#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/joint/node/node.hpp"
#include "core/joint/node/shape.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kRound = 1e-12;  // of the lengths involved
constexpr double kAngle = 1e-9;   // deg

/// Computes the angle between two unit vectors by half tangents.
double between(const Vector3d& a, const Vector3d& b) {
  return 2.0 * elementary::atan2((a - b).norm(), (a + b).norm());
}

/// The cutter's axis along the world's axes, from the end's own origin (so a node far out in the
/// world loses no digits), computed from only the four numbers: rotated and tilted step by step.
struct Line {
  Vector3d point, direction;
};
Line from_origin(const MemberFrame& frame, const TubeCutter& t) {
  const auto a = elementary::sincos(t.inclination.rad());
  const auto b = elementary::sincos(t.clocking.rad());
  Eigen::Matrix3d tilt, clock;
  tilt << 1, 0, 0, 0, a.cos, -a.sin, 0, a.sin, a.cos;
  clock << b.cos, -b.sin, 0, b.sin, b.cos, 0, 0, 0, 1;
  const Eigen::Matrix3d out = frame.rows.transpose() * clock * tilt;
  return {frame.rows.transpose() * Vector3d(0, 0, t.height) -
              t.offset * (frame.rows.transpose() * clock.col(0)),
          out.col(2)};
}

double from_line(const Vector3d& p, const Line& line) {
  return (p - line.point).cross(line.direction).norm();
}

struct Worst {
  double axis = 0.0, angle = 0.0, eccentricity = 0.0, gap = 0.0, frame = 0.0;
};

/// Computes the smallest distance of a point to a member's axis: to its ends, or to the line if the
/// foot is between them (both angles at the ends are acute).
double to_axis(const Vector3d& p, const Member& m) {
  const Vector3d along = m.finish - m.start;
  const double ends = std::min((p - m.start).norm(), (p - m.finish).norm());
  const bool between_ends = (p - m.start).dot(along) > 0.0 && (m.finish - p).dot(along) > 0.0;
  return between_ends ? (p - m.start).cross(along).norm() / along.norm() : ends;
}

/// Returns the point where two outlines cross, from the point where the axes do: tubes that leave
/// along unit `u` and `v`.
Vector3d corner_of(const Vector3d& u, double r, const Vector3d& v, double s) {
  const Vector3d side = u.cross(v).normalized();
  const Vector3d from_u = u.cross(side), from_v = side.cross(v);
  return r * from_u + (s - r * from_u.dot(from_v)) / u.dot(from_v) * u;
}

/// Returns how far a member reaches from its axis in the plane of its own direction and the
/// other's: of a section half the side that lies in that plane.
double extent(const Member& m, const Vector3d& own, const Vector3d& other) {
  if (!m.section) return m.outer_radius;
  const Vector3d side = own.cross(other).normalized();
  const Vector3d up = m.up->cross(own);
  return std::abs(up.normalized().dot(side)) > std::sqrt(0.5) ? 0.5 * m.section->height
                                                              : 0.5 * m.section->width;
}

/// Checks that a mitre's plane is at equal angles to both members, the end's own before it and the
/// other behind it, or holds the corner of their outlines; and that its point is midway between
/// them, equally far from both axes.
void see_mitre(const NodeSpec& spec, const MemberEnd& end, const CutBy& cut, Worst& worst) {
  const auto& member = spec.members[end.member];
  const auto& other = spec.members[cut.member];
  const Vector3d normal = (end.frame.rows.transpose() * cut.plane->normal).normalized();
  const Vector3d& origin = end.frame.origin;
  const Vector3d point = end.frame.rows.transpose() * cut.plane->point;  // from there
  const Vector3d own = end.frame.rows.row(2);
  Vector3d along = (other.finish - other.start).normalized();
  if (along.dot(normal) > 0.0) along = -along;
  const double off = cut.stated && cut.stated->plane == MitrePlane::corner_to_corner
                         ? 0.5 * kPi - between(corner_of(own, extent(member, own, along), along,
                                                         extent(other, along, own)),
                                               normal)
                         : between(own, normal) + between(along, normal) - kPi;
  worsen(worst.angle, std::abs(off) * kDegPerRad);
  // At least both lengths, because any of the ends may be the plane's own point.
  const auto ends = [&](const Member& m) {
    return (m.start - origin - point).norm() + (m.finish - origin - point).norm();
  };
  const double scale = ends(member) + ends(other);
  const auto aside = [&](const Member& m) {
    return from_line(point, {m.start - origin, (m.finish - m.start).normalized()});
  };
  worsen(worst.axis, std::abs(aside(member) - aside(other)) / scale);
  worsen(worst.eccentricity, std::abs(aside(member) + aside(other) - cut.eccentricity) / scale);
  worsen(worst.gap, std::abs(to_axis(end.frame.origin, other) - cut.gap) / scale);
}

/// Checks a section's box against its member: its axis, and that `up` lies in the plane of its
/// height and its axis.
void see_box(const MemberEnd& end, const RectangularTubeCutter& box, const Member& other,
             Worst& worst) {
  const Eigen::Matrix3d out = end.frame.rows.transpose();
  const Line line{out * box.point, (out * box.direction).normalized()};
  const double scale =
      (other.start - end.frame.origin).norm() + (other.finish - end.frame.origin).norm();
  for (const Vector3d& tip : {other.start, other.finish})
    worsen(worst.axis, from_line(tip - end.frame.origin, line) / scale);
  const Vector3d up = (out * box.up).normalized(), own = *other.up;
  const Vector3d off = own - own.dot(line.direction) * line.direction;
  worsen(worst.angle, between(up, off.normalized()) * kDegPerRad);
}

void see(const NodeSpec& spec, const MemberEnd& end, const CutBy& cut, Worst& worst) {
  if (cut.plane) return see_mitre(spec, end, cut, worst);
  if (cut.box) see_box(end, *cut.box, spec.members[cut.member], worst);
  const auto& member = spec.members[end.member];
  const auto& other = spec.members[cut.member];
  const auto& t = cut.placement.tube;
  const Vector3d own =
      member.at(end.end == End::start ? End::finish : End::start) - member.at(end.end);
  const Vector3d along = other.finish - other.start;
  const Vector3d common = own.cross(along);
  const double sine = common.norm() / (own.norm() * along.norm());
  const double scale = (other.start - end.frame.origin).norm() +
                       (other.finish - end.frame.origin).norm() + std::abs(t.height) +
                       std::abs(t.offset);
  const auto line = from_origin(end.frame, t);
  for (const Vector3d& tip : {other.start, other.finish})
    worsen(worst.axis, from_line(tip - end.frame.origin, line) / scale);
  worsen(
      worst.angle,
      std::abs(between(own.normalized(), along.normalized()) - t.inclination.rad()) * kDegPerRad);
  const double apart =
      std::abs((other.start - end.frame.origin).dot(common)) / (own.norm() * along.norm());
  worsen(worst.eccentricity, std::abs(apart - cut.eccentricity * sine) / scale);
  worsen(worst.gap, std::abs(to_axis(end.frame.origin, other) - cut.gap) / scale);
}

double frame_error(const NodeSpec& spec, const MemberEnd& end) {
  const auto& m = spec.members[end.member];
  const Vector3d far = m.at(end.end == End::start ? End::finish : End::start);
  const double length = (m.finish - m.start).norm();
  const Vector3d seen = end.frame.local(far);
  const double square =
      (end.frame.rows * end.frame.rows.transpose() - Eigen::Matrix3d::Identity()).norm();
  return worst_of({square, std::abs(end.frame.rows.determinant() - 1.0),
                   (seen - Vector3d(0, 0, length)).norm() / length,
                   (end.frame.origin - m.at(end.end)).norm()});
}

/// Returns the number of cuts against the rule of priority, diameter and order, or in both
/// directions; mitres in one.
double wrong_cuts(const NodeSpec& spec, const Nodes& nodes) {
  std::set<std::pair<std::size_t, std::size_t>> cuts, mitres;
  double wrong = 0.0;
  for (const auto& end : nodes.ends)
    for (const auto& cut : end.cut_by)
      if (cut.plane) mitres.insert({end.member, cut.member});
  for (const auto& [a, b] : mitres) wrong += mitres.contains({b, a}) ? 0.0 : 1.0;
  for (const auto& end : nodes.ends)
    for (const auto& cut : end.cut_by) {
      if (cut.plane) continue;
      const auto& by = spec.members[cut.member];
      const auto& of = spec.members[end.member];
      const bool lower = by.priority > of.priority ||
                         (by.priority == of.priority && by.half_size() < of.half_size() &&
                          !detail::carries(by, of));
      if (lower || cuts.contains({end.member, cut.member})) wrong += 1.0;
      cuts.insert({cut.member, end.member});
    }
  return wrong;
}

}  // namespace

std::vector<Check> verify(const NodeSpec& spec, const Nodes& nodes) {
  Worst worst;
  for (const auto& end : nodes.ends) {
    if (stopped()) return {};
    worsen(worst.frame, frame_error(spec, end));
    for (const auto& cut : end.cut_by) see(spec, end, cut, worst);
  }
  return {{"axis_in_world", worst.axis, kRound, ""},
          {"inclination", worst.angle, kAngle, "deg"},
          {"eccentricity", worst.eccentricity, kRound, ""},
          {"gap", worst.gap, kRound, ""},
          {"frame", worst.frame, kRound, ""},
          {"one_cuts_the_other", wrong_cuts(spec, nodes), 0.0, ""}};
}

}  // namespace tubecut::joint
