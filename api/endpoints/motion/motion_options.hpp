#pragma once

#include "api/endpoints/motion/motion_codec.hpp"
#include "api/wire/reader.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::api {

inline constexpr Range kBeam{.min = 0.0, .max = 1e5};  // mm of metal

/// How a cut is to be run: a request's `motion`.
[[nodiscard]] motion::Motion decode_motion(Reader& in, const CutSource& cut);

/// The same for a whole part, with the moves between its cuts.
struct PartMotion {
  motion::Motion motion = {};
  torch::Setup setup = {};
  bool marks = false;
};
[[nodiscard]] PartMotion decode_part_motion(Reader& in, const motion::Machine& machine);

}  // namespace tubecut::api
