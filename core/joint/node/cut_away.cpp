#include "core/joint/node/cut_away.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/joint/node/shape.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr double kStillInside = 0.02;  // mm: coordinates are rounded
constexpr double kFirstStep = 0.25;    // mm, of a doubling search
constexpr int kBisections = 40;

/// Returns true if the point is next to the member between its ends.
bool between_ends(const Member& m, const Vector3d& point) {
  const Vector3d along = m.finish - m.start;
  const double share = (point - m.start).dot(along) / along.squaredNorm();
  return share >= 0.0 && share <= 1.0;
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
    if (!between_ends(by, point) || !within(0.0)) continue;
    double low = 0.0, high = kFirstStep;
    const double most = 100.0 * by.reach();
    while (high < most && within(high)) low = high, high *= 2.0;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (within(middle) ? low : high) = middle;
    }
    out = std::max(out, high);
  }
  return out;
}

}  // namespace tubecut::joint::detail
