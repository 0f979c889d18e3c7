#pragma once

#include <string>

#include "api/endpoints/frames/frame_answer.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// The cut list as CSV: a row a part, one that is not there too.
[[nodiscard]] std::string cut_list_csv(const FrameJob& frame, const MadeParts& made,
                                       const Caption& caption);

/// Returns an assembly as ISO 10303-21: each part a solid, once, and each member an instance in its
/// place in the world. If members have no part, the head has the warning. Throws UnfitOption if a
/// part's holes meet.
[[nodiscard]] std::string frame_step(const FrameJob& frame, const MadeParts& made,
                                     const Caption& caption);

}  // namespace tubecut::api
