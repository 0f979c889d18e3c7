#include "core/joint/node/passing.hpp"

#include <Eigen/Geometry>

#include "core/joint/node/shape.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kEquallyWide = 1e-9;  // mm
constexpr int kWayHalvings = 60;

/// Returns the length along unit `along` from `from`, which lies inside, to the endless surface.
double way_out(const Member& chord, const Vector3d& from, const Vector3d& along, double most) {
  double inside = 0.0, outside = most;
  for (int i = 0; i < kWayHalvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (detail::distance_from(chord, from + middle * along) < 0.0 ? inside : outside) = middle;
  }
  return outside;
}

}  // namespace

Passing which_passes(const Member& a, const Member& b) {
  const Vector3d across =
      (a.finish - a.start).normalized().cross((b.finish - b.start).normalized());
  const double sine = across.norm();
  if (!(sine > 2.0 * kParallel)) return Passing::neither;
  const double first = detail::support(a, across / sine),
               second = detail::support(b, across / sine);
  if (std::abs(first - second) <= kEquallyWide) return Passing::neither;
  return first < second ? Passing::first : Passing::second;
}

std::optional<StopsShort> stops_short(const Member& branch, const Member& chord) {
  const Vector3d u = (branch.finish - branch.start).normalized();
  const Vector3d v = (chord.finish - chord.start).normalized();
  const Vector3d n = u.cross(v);
  const double sine = n.norm();
  if (!(sine > 2.0 * kParallel)) return std::nullopt;
  const double nearest = (chord.start - branch.start).cross(v).dot(n) / (sine * sine);
  const Vector3d middle = branch.start + nearest * u;
  const double most = 2.0 * chord.reach() / sine;
  const bool meets = detail::distance_from(chord, middle) < 0.0;
  for (const auto end : {End::start, End::finish}) {
    const Vector3d out = end == End::start ? Vector3d(-u) : u;
    const double far = (branch.at(end) - middle).dot(out);
    const double missing = (meets ? way_out(chord, middle, out, most) : 0.0) - far;
    if (missing > kFlush) return StopsShort{end, missing};
  }
  return std::nullopt;
}

Result<void> check_passes(const Called& branch, const Called& chord, const std::string& at) {
  if (which_passes(branch.member, chord.member) != Passing::first)
    return fail({.code = ErrorCode::joint_contradicts,
                 .member = at,
                 .hint = branch.name + " does not pass through " + chord.name +
                         ": across both axes it is not the narrower, or they are parallel"});
  const auto end = stops_short(branch.member, chord.member);
  if (!end) return {};
  return fail({.code = ErrorCode::joint_contradicts,
               .member = at,
               .hint = "the " + std::string(name_of(end->end)) + " of " + branch.name +
                       " would have to go on by " + brief(end->missing) + " mm to pass through " +
                       chord.name + "; extend it, or join it by set_in or set_on"});
}

}  // namespace tubecut::joint
