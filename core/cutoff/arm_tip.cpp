#include "core/cutoff/arm_tip.hpp"

#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::cutoff {

ArmTip::ArmTip(const Linkage& linkage, double rad_per_mm)
    : linkage_(linkage),
      rate_(rad_per_mm),
      height_(std::sqrt(linkage.pivot_distance * linkage.pivot_distance -
                        linkage.pivot_offset * linkage.pivot_offset)),
      slot_(elementary::sincos(linkage.slot_angle.rad())) {
  rod_height_ = -at(0.0).feed;  // x0 - A tan psi0 = 0
}

TipFeed ArmTip::at(double stroke) const {
  const auto arm = elementary::sincos(linkage_.rest_angle.rad() + rate_ * stroke);
  const double px = linkage_.arm * arm.cos;
  const double py = linkage_.arm * arm.sin;
  const double w = px - linkage_.pivot_offset;  // from O2 to P, along X
  const double u = py - height_;
  const double along =
      u * slot_.sin - w * slot_.cos;  // |O2 P| cos psi and |O2 P| sin psi, psi = pi - alpha - beta
  const double across = w * slot_.sin + u * slot_.cos;
  const double tangent = across / along;
  const double secant2 = 1.0 + tangent * tangent;
  const double reach2 = w * w + u * u;
  const double radial = w * px + u * py;   // O2P . P: beta' = radial/reach2
  const double turning = u * px - w * py;  // O2P . P', half the slope of reach2
  const double first = radial / reach2;
  const double second = turning * (reach2 - 2.0 * radial) / (reach2 * reach2);
  const double scale = linkage_.pivot_offset * secant2;
  const double span = linkage_.arm * (linkage_.arm + linkage_.pivot_distance);
  return {.feed = rod_height_ - linkage_.pivot_offset * tangent,
          .first = rate_ * scale * first,
          .second = rate_ * rate_ * scale * (second - 2.0 * tangent * first * first),
          .second_terms = rate_ * rate_ * scale *
                          (std::abs(second) + 2.0 * (1.0 + std::abs(tangent)) * first * first),
          .elevation_cosine = std::abs(along) / std::sqrt(reach2),
          .tangency = radial / span};
}

double ArmTip::stroke_of(double feed, double guess) const {
  double stroke = guess;
  double before = HUGE_VAL;
  for (int step = 0; step < 50; ++step) {
    const TipFeed here = at(stroke);
    const double change = (feed - here.feed) / here.first;
    if (!(std::abs(change) < before) && step > 5) break;  // stop at the rounding floor
    before = std::abs(change);
    stroke += change;
    if (change == 0.0) break;
  }
  return stroke;
}

}  // namespace tubecut::cutoff
