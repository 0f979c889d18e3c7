#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/joint/node_parts.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kScan = 180;  // generators looked at for ghosts and the highest z

/// Every generator of radius rho meets some cutter.
bool closed(std::span<const PreparedCutter> cutters, double rho) {
  for (const auto& cutter : cutters)
    if (met(cutter, rho) == Met::always) return true;
  return divide(cutters, rho).open.empty();
}

/// Cheap bounds of a cutter's sheet on radius rho: the highest z, and the reach along its own axis.
struct Bounds {
  double z, axial;
};
struct BoundsOn {
  double rho;
  Bounds operator()(const PlaneCutter& plane) const {
    const Vector3d n = plane.normal / plane.normal.z();
    return {plane.point.dot(n) + rho * elementary::hypot(n.x(), n.y()), 0.0};
  }
  Bounds operator()(const TubeCutter& t) const {
    const auto turn = elementary::sincos(t.inclination.rad());
    return {t.height + (t.radius + rho * std::abs(turn.cos)) / turn.sin,
            (t.radius * std::abs(turn.cos) + rho) / turn.sin};
  }
};

/// Is w, along the axis of the cutter from the common perpendicular, beyond the member's ends?
bool beyond(const Member& m, const CutBy& cut, double w) {
  const double from = cut.placement.point_axial;
  const double length = (m.finish - m.start).norm();
  const double slack = 1e-9 * (length + std::abs(from));
  return w < from - slack || w > from + length + slack;
}

/// Ghosts and the highest z, read on the generators of one surface.
void scan(const NodeSpec& spec, std::span<const PreparedCutter> cutters, double rho, double length,
          MemberEnd& end) {
  for (std::size_t k = 0; k < kScan; ++k) {
    const auto line =
        generator_at(rho, kTwoPi * static_cast<double>(k) / static_cast<double>(kScan));
    const auto top = highest(cutters, line);
    if (!top) continue;
    end.consumed = end.consumed || top->z > length;
    auto& cut = end.cut_by[top->cutter];
    if (cut.plane) continue;
    if (const auto at = hit(cutters[top->cutter], line))
      cut.ghost = cut.ghost || beyond(spec.members[cut.member], cut, at->axial);
  }
}

}  // namespace

void inspect(const NodeSpec& spec, MemberEnd& end) {
  const auto& m = spec.members[end.member];
  const double length = (m.finish - m.start).norm();
  const auto cutters = prepared_seats(end);
  for (const double rho : {m.outer_radius - m.wall, m.outer_radius}) {
    end.open = end.open || !closed(cutters, rho);
    const bool nothing = std::ranges::all_of(end.cut_by, [&](const CutBy& cut) {
      const auto most = by_kind(seat_of(cut), BoundsOn{rho});
      if (cut.plane) return most.z < length;
      return most.z < length && !beyond(spec.members[cut.member], cut, most.axial) &&
             !beyond(spec.members[cut.member], cut, -most.axial);
    });
    if (!nothing) scan(spec, cutters, rho, length, end);
  }
}

}  // namespace tubecut::joint::detail
