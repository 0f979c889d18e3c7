#pragma once

#include <string>

#include "api/endpoints/frames/frame_answer.hpp"

namespace tubecut::api {

/// What core's frame calls "members/3/start" or "joints/1/kind", as the request has it: pieces that
/// are merged are named each by itself.
[[nodiscard]] std::string in_request(const FrameJob& frame, const std::string& path);
[[nodiscard]] Error in_request(const FrameJob& frame, Error error);

/// A pointer into the request of a part, as one into the frame's request: what the part has from a
/// member, a joint, an end or the defaults.
[[nodiscard]] std::string in_frame(const FrameJob& frame, std::size_t part,
                                   const std::string& pointer);
[[nodiscard]] Problem in_frame(const FrameJob& frame, std::size_t part, Problem problem);

}  // namespace tubecut::api
