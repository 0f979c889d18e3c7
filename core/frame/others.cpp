#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/frame/frame_parts.hpp"
#include "core/joint/node/node_parts.hpp"

namespace tubecut::frame::detail {
namespace {

using Eigen::Vector3d;
using joint::End;

constexpr double kEquallyNear = 1e-6;  // mm

std::string at_joint(std::size_t i) { return "joints/" + std::to_string(i); }

/// Returns the signed distance of a point from the surface, negative inside.
struct Outside {
  const Vector3d& point;
  double operator()(const joint::AxisTube& t) const {
    const Vector3d d = t.axis.direction.normalized();
    return (point - t.axis.point).cross(d).norm() - t.radius;
  }
  template <class Kind>
  double operator()(const Kind& kind) const {
    return kind.solid().distance(point);
  }
};

/// Returns how far a member, from one of its ends along `into`, ends before it meets the surface;
/// 0 if it meets it.
struct Before {
  const Vector3d& end;
  const Vector3d& into;
  double operator()(const joint::PlaneCutter& plane) const {
    const Vector3d n = plane.normal.normalized();
    const double height = (end - plane.point).dot(n), rise = into.dot(n);
    if (!(height * rise > 0.0) || std::abs(rise) <= joint::kParallel * into.norm()) return 0.0;
    return height / rise * into.norm();  // along the axis; parallel to it, the cut reports it
  }
  double operator()(const joint::AxisTube& t) const {
    return straight(joint::TubeSolid{t.axis.point, t.axis.direction.normalized(), t.radius});
  }
  template <class Kind>
  double operator()(const Kind& kind) const {
    return straight(kind.solid());
  }
  template <class Solid>
  [[nodiscard]] double straight(const Solid& solid) const {
    return std::max(0.0, solid.least_distance(end, end + into));
  }
};

}  // namespace

Result<End> end_at(const FrameSpec& spec, std::size_t index) {
  const auto& said = spec.joints[index];
  if (said.end) return *said.end;
  if (said.plate) return at_plate(spec, index).map([](const AtPlate& at) { return at.end; });
  const auto& m = spec.members[said.member];
  const auto& partner = spec.others[said.with].partner;
  const double start = std::abs(joint::by_kind(partner, Outside{m.start}));
  const double finish = std::abs(joint::by_kind(partner, Outside{m.finish}));
  if (std::abs(start - finish) > kEquallyNear) return start < finish ? End::start : End::finish;
  return fail({.code = ErrorCode::ambiguous_connection,
               .member = at_joint(index),
               .hint = "both ends are equally near; select one with end"});
}

Result<void> check_near(std::size_t index, const joint::Member& member, const EndOff& off) {
  const double most = joint::detail::far_end(member, member);
  if (!(off.distance > most)) return {};
  return fail({.code = ErrorCode::no_contact,
               .member = at_joint(index),
               .got = off.distance,
               .limit = most,
               .unit = "mm",
               .hint = "the member's end is too far from " + off.what +
                       " along its axis: the joint would cut off or add that much; move the end "
                       "or " +
                       off.what + off.instead});
}

// A model may have tubes that a body trims, but no end is lengthened far to one.
Result<void> check_near_other(const FrameSpec& spec, std::size_t index, End end) {
  const auto& said = spec.joints[index];
  const auto& m = spec.members[said.member];
  const auto& other = spec.others[said.with];
  const auto name = other.name.empty() ? std::string("the other body") : other.name;
  const double off = joint::by_kind(other.partner, Before{m.at(end), m.into(end)});
  return check_near(index, m, {.distance = off, .what = name});
}

}  // namespace tubecut::frame::detail
