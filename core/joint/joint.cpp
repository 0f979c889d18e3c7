#include "core/joint/joint.hpp"

#include "core/base/elementary.hpp"

namespace tubecut::joint {
namespace {

struct Grow {
  double by;

  void operator()(TubeCutter& tube) const { tube.radius += by; }
  void operator()(PlaneCutter& plane) const {
    const double up = plane.normal.z() < 0.0 ? -1.0 : 1.0;
    plane.point += up * by * plane.normal.normalized();
  }
  void operator()(BoxCutter& box) const {
    box.width += 2.0 * by;
    box.height += 2.0 * by;
    box.corner += by;
  }
  void operator()(ConeCutter& cone) const {
    cone.radius += by / elementary::cos(cone.half_angle.rad());
  }
  void operator()(ElbowCutter& elbow) const { elbow.radius += by; }
};

}  // namespace

double seat(const std::optional<Joint>& stated, double coating, double unstated) {
  if (!stated) return coating + unstated;
  if (stated->kind == JointKind::set_in) return -stated->depth.value_or(0.0);
  if (stated->kind == JointKind::mitre) return 0.5 * stated->gap;
  return coating + stated->gap;
}

Cutter grown(Cutter cutter, double by) {
  if (by != 0.0) std::visit(Grow{by}, cutter);
  return cutter;
}

}  // namespace tubecut::joint
