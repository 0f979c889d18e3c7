#pragma once

#include <vector>

#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// Length of a cross's arms around the position of a partner, mm.
inline constexpr double kCrossArm = 5.0;

/// Returns the cuts with strokes for a part's marks before them, square to the wall, in the order
/// of its sequence: the datum line as one stroke; for a partner its line, or a cross at its
/// position. The texts of marks are left to a person.
[[nodiscard]] std::vector<TorchCut> with_marks(const part::PartSpec& spec, const part::Part& part,
                                               std::vector<TorchCut> cuts);

}  // namespace tubecut::torch
