#include "core/groove/probe.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/groove/machine_space.hpp"
#include "core/groove/mill_limits.hpp"
#include "core/groove/mill_parts.hpp"
#include "core/groove/surface.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::groove {
namespace {

constexpr double kSamePlace = 1e-12;  // rad

/// Returns the axes at `omega` of the linear motion from position to position.
AxisPosition on_path(const std::vector<MillPosition>& all, double omega) {
  const auto after = std::ranges::upper_bound(all, omega + kSamePlace, {},
                                              [](const MillPosition& p) { return p.omega.rad(); });
  const MillPosition& from = after == all.begin() ? all.back() : *(after - 1);
  const double passed = omega - from.omega.rad();
  if (std::abs(passed) <= kSamePlace) return from.at;
  const MillPosition& to = after == all.end() ? all.front() : *after;
  const double whole = math::whole_turn((to.omega - from.omega).rad());
  const double share = math::whole_turn(passed) / whole;
  const double turned = nearest_turn(to.at.b.rad(), from.at.b.rad()) - from.at.b.rad();
  AxisPosition out = from.at;
  out.x += share * (to.at.x - from.at.x);
  out.z += share * (to.at.z - from.at.z);
  out.b = Angle::rad(from.at.b.rad() + share * turned);
  return out;
}

/// Transforms a point of the surface into the half plane of a section that is `delta` away.
Eigen::Vector3d in_half_plane(const Eigen::Vector3d& p, double delta) {
  const double radial = elementary::hypot(p.x(), p.y());
  const auto [sin, cos] = elementary::sincos(delta);
  return {radial * cos, radial * sin, p.z()};
}

Result<Probed> probed(const JointGeometry& joint, const MillPathSpec& spec, const MillPath& path,
                      const ProbePoint& asked) {
  const Cone cone{spec.mill};
  const Angle omega = Angle::rad(math::whole_turn(asked.omega.rad()));
  const auto stand = section(joint, omega), ruling = section(joint, asked.ruling);
  if (!stand || !ruling) return fail({.code = stand ? ruling.error() : stand.error()});
  const ToolPose start = initial_pose(joint, *stand, spec.mill, spec.setup);
  Probed out{.point = surface_point(joint, *ruling, asked.v),
             .at_before = axis_position(start, spec.setup, omega),
             .at = on_path(path.positions, omega.rad())};
  out.at.c = out.at_before.c;
  const auto seen = in_half_plane(out.point, (asked.ruling - omega).rad());
  out.before = cone.flank(start, seen);
  out.after = cone.flank(tool_pose(out.at, spec.setup), seen);
  return out;
}

/// Returns the point of all contact lines that is first in the order `deeper`.
template <class Deeper>
Deepest deepest(const MillPath& path, ContactLine MillPosition::*line, Deeper deeper) {
  Deepest out;
  bool any = false;
  for (const MillPosition& p : path.positions) {
    const auto& contacts = p.*line;
    for (std::size_t i = 0; i < contacts.gap.size(); ++i) {
      if (any && !deeper(contacts.gap[i], out.distance)) continue;
      any = true;
      out.distance = contacts.gap[i];
      out.at = {p.omega, p.omega + Angle::rad(contacts.offset[i]),
                static_cast<double>(i) / static_cast<double>(contacts.gap.size() - 1)};
    }
  }
  return out;
}

Result<DeepestPlaces> places(const JointGeometry& joint, const MillPath& path,
                             ContactLine MillPosition::*line) {
  DeepestPlaces out{.over = deepest(path, line, std::less<>{}),
                    .under = deepest(path, line, std::greater<>{})};
  for (auto* place : {&out.over, &out.under}) {
    place->at.ruling = Angle::rad(math::whole_turn(place->at.ruling.rad()));
    const auto found = section(joint, place->at.ruling);
    if (!found) return fail({.code = found.error()});
    place->point = surface_point(joint, *found, place->at.v);
  }
  return out;
}

}  // namespace

Result<Probe> probe(const MillPathSpec& spec, const MillPath& path,
                    const std::vector<ProbePoint>& asked) {
  TRY(const auto joint, joint_geometry(spec.groove));
  Probe out;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    TRY(auto one, under("probe/" + std::to_string(i), probed(joint, spec, path, asked[i])));
    out.points.push_back(std::move(one));
  }
  TRY(out.before, places(joint, path, &MillPosition::before));
  TRY(out.after, places(joint, path, &MillPosition::after));
  return out;
}

Check verify(const MillPathSpec& spec, const std::vector<ProbePoint>& asked, const Probe& probe) {
  const Machine machine{spec};
  double worst = 0.0;
  const auto hold = [&](const AxisPosition& at, const Eigen::Vector3d& point, double stated) {
    const double off = std::abs(
        flank_distance(spec.mill, machine.tool(at), machine.table(at.c) * point + machine.lift()) -
        stated);
    if (!(off <= worst)) worst = off;
  };
  for (std::size_t i = 0; i < asked.size() && !stopped(); ++i) {
    const Probed& one = probe.points[i];
    hold(one.at_before, one.point, one.before);
    hold(one.at, one.point, one.after);
  }
  return {"probe", worst, kContactLimit, "mm"};
}

}  // namespace tubecut::groove
