#pragma once

#include "api/endpoints/motion/motion_codec.hpp"
#include "api/wire/reader.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::api {

inline constexpr Range kBeam{.min = 0.0, .max = 1e5};  // mm of metal

/// How a cut is to be run: a request's `motion`. `certain`: the request states a cut whose target
/// is understood; otherwise fields of any kind of target are accepted, because the cut is refused.
[[nodiscard]] motion::Motion decode_motion(Reader& in, const CutSource& cut, bool certain);

/// The tube of a part; unknown if the part is refused, so that a round one need not be meant.
enum class Tube { round, section, unknown };

/// The same for a whole part, with the moves between its cuts.
struct PartMotion {
  motion::Motion motion = {};
  torch::Setup setup = {};
  bool marks = false;
};
[[nodiscard]] PartMotion decode_part_motion(Reader& in, const motion::Machine& machine, Tube tube);

}  // namespace tubecut::api
