#pragma once

#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// A way onto a small opening's cut from the deepest place in its scrap: half a circle that is
/// tangent to the cut, or straight where the cut is narrower than that is worth. Begins where the
/// way is nearest to square to the cut; ends after the overcut.
///
/// Errors  those of motion::track.
/// Source  docs/theory/cutouts.md, section 4.
[[nodiscard]] Result<motion::CutWithLead> centre_lead(const TorchCut& cut, double overcut);

}  // namespace tubecut::torch
