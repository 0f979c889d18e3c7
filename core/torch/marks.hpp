#pragma once

#include <vector>

#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// How far a cross reaches from where a partner stands, mm.
inline constexpr double kCrossArm = 5.0;

/// Strokes of a part's marks before its cuts, square to the wall, in the order of its sequence: the
/// datum line as one, of a partner its line, or a cross where it stands. What a mark says in
/// letters is left to a person.
[[nodiscard]] std::vector<TorchCut> with_marks(const part::PartSpec& spec, const part::Part& part,
                                               std::vector<TorchCut> cuts);

}  // namespace tubecut::torch
