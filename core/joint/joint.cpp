#include "core/joint/joint.hpp"

namespace tubecut::joint {

double seat(const std::optional<Joint>& stated, double coating, double unstated) {
  if (!stated) return coating + unstated;
  if (stated->kind == JointKind::set_in) return -stated->depth.value_or(0.0);
  if (stated->kind == JointKind::mitre) return 0.5 * stated->gap;
  return coating + stated->gap;
}

}  // namespace tubecut::joint
