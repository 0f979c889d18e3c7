#pragma once

#include <vector>

#include "core/cutoff/arm_tip.hpp"
#include "core/cutoff/verify.hpp"

namespace tubecut::cutoff {

/// The parts of `verify`; each appends its checks.
void verify_command(const FeedCurveSpec& spec, const FeedCurve& curve, const ArmTip& tip,
                    std::vector<Check>& checks);
void verify_cycle(const FeedCurveSpec& spec, const FeedCurve& curve, const ArmTip& tip,
                  std::vector<Check>& checks);

/// Returns the scale of a feed at a position of the linkage: |x| + A/cos^2 psi.
[[nodiscard]] inline double feed_scale(const Linkage& linkage, const TipFeed& here) {
  const double x = here.feed < 0.0 ? -here.feed : here.feed;
  return x + linkage.pivot_offset / (here.elevation_cosine * here.elevation_cosine);
}

}  // namespace tubecut::cutoff
