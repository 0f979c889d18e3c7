#include "core/joint/node/cut_away.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/joint/node/shape.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr double kStillInside = 0.02;   // mm: coordinates are rounded
constexpr double kClearlyInside = 0.5;  // mm: a line that only touches a member is not cut by it
constexpr double kFirstStep = 0.25;     // mm, of a doubling search
constexpr int kBisections = 40;

/// Returns true if the point is next to the member between its ends, or by rounding beyond one: of
/// two members in line, a point where they meet is next to both.
bool between_ends(const Member& m, const Vector3d& point) {
  const Vector3d along = m.finish - m.start;
  const double length = along.norm(), at = (point - m.start).dot(along) / length;
  return at >= -kStillInside && at <= length + kStillInside;
}

/// Returns a way, >= 0, along unit `into` from a point to a place inside the member's endless
/// surface, or on it; empty if there is none.
std::optional<double> way_inside(const Member& m, const Vector3d& point, const Vector3d& into) {
  const Vector3d axis = (m.finish - m.start).normalized(), from = point - m.start;
  const double cosine = into.dot(axis);
  const double nearest =
      (from.dot(axis) * cosine - from.dot(into)) / (1.0 - cosine * cosine);  // to the axis
  const auto off = [&](double way) { return distance_from(m, point + way * into); };
  if (off(0.0) <= kStillInside) return 0.0;
  if (nearest >= 0.0 && off(nearest) <= -kClearlyInside) return nearest;
  const Vector3d foot = from + nearest * into;
  if (!m.section || !((foot - foot.dot(axis) * axis).norm() < m.reach())) return std::nullopt;
  // A line across a corner of the section; the distance from a convex body is convex along it.
  const double half = m.reach() / std::sqrt(1.0 - cosine * cosine);
  double low = std::max(0.0, nearest - half), high = std::max(0.0, nearest + half);
  for (int i = 0; i < kBisections; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (off(a) < off(b) ? high : low) = off(a) < off(b) ? b : a;
  }
  return off(low) <= -kClearlyInside ? std::optional(low) : std::nullopt;
}

}  // namespace

CutAway::CutAway(const Joints& joints, std::size_t own, std::size_t member) {
  const auto& [spec, applied, lines, joined] = joints;
  const auto& m = spec.members[member];
  for (const auto end : {2 * member, 2 * member + 1})
    for (const auto& touch : joined[end]) {
      const auto other = touch.other;
      if (other == own || !is_set_on(applied, member, other) ||
          lines.line[member] == lines.line[other] || applied.mitres.contains({end, other}) ||
          !lines.goes_before(spec, other, member) ||
          sine_between(m, spec.members[other]) < kNearParallel)
        continue;
      cuts_.push_back({spec.members[other], m.into(end_of(end)).normalized()});
    }
}

double CutAway::length(const Vector3d& point) const {
  double out = 0.0;
  for (const auto& [by, into] : cuts_) {
    const auto within = [&, &by = by, &into = into](double way) {
      return distance_from(by, point + way * into) <= kStillInside;
    };
    const auto first = way_inside(by, point, into);
    if (!first || !between_ends(by, point + *first * into)) continue;
    double step = kFirstStep;
    const double most = 100.0 * by.reach();
    while (step < most && within(*first + step)) step *= 2.0;
    double low = *first, high = *first + step;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (within(middle) ? low : high) = middle;
    }
    out = std::max(out, high);
  }
  return out;
}

}  // namespace tubecut::joint::detail
