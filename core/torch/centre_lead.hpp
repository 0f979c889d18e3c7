#pragma once

#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// How the torch goes from the deepest place of the scrap onto the cut.
enum class CentreWay { half_circle, straight };

/// A way onto a small opening's cut from the deepest place in its scrap: half a circle that is
/// tangent to the cut, or straight where the cut is narrower than that is worth. Begins at the
/// nearest place to which the way is square; ends after the overcut.
///
/// Errors  those of motion::track.
/// Source  docs/theory/cutouts.md, section 4.
[[nodiscard]] Result<motion::CutWithLead> centre_lead(const TorchCut& cut, double overcut,
                                                      CentreWay way);

/// Returns the cut with a point in the middle of each long straight piece, because a window has
/// rows at its corners only, where no lead fits.
[[nodiscard]] TorchCut with_middles(TorchCut cut);

}  // namespace tubecut::torch
