#pragma once

#include <string>
#include <vector>

#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// Length of a cross's arms around the position of a partner, mm.
inline constexpr double kCrossArm = 5.0;

/// Returns the name of a text's stroke, of those counted from 0.
[[nodiscard]] std::string stroke_name(const cutout::Lettering& text, std::size_t stroke);

/// Returns the cuts with strokes for a part's marks before them, square to the wall, in the order
/// of its sequence: the datum line as one stroke; for a partner its line, or a cross at its
/// position; the strokes of each text. The part's own name is left to a person.
[[nodiscard]] std::vector<TorchCut> with_marks(const part::PartSpec& spec, const part::Part& part,
                                               std::vector<TorchCut> cuts);
/// The same of a part that is not round. A stroke within one flat keeps the torch square to it.
[[nodiscard]] std::vector<TorchCut> with_marks(const part::SectionPartSpec& spec,
                                               const part::SectionPart& part,
                                               std::vector<TorchCut> cuts);

}  // namespace tubecut::torch
