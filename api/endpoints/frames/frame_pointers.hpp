#pragma once

#include <string>

#include "api/endpoints/frames/frame_answer.hpp"

namespace tubecut::api {

/// Maps a path of core's frame, such as "members/3/start" or "joints/1/kind", to the request:
/// merged pieces are named individually.
[[nodiscard]] std::string in_request(const FrameJob& frame, const std::string& path);
[[nodiscard]] Error in_request(const FrameJob& frame, Error error);

/// Maps a pointer into the request of a part to one into the frame's request: to the member, joint,
/// end or default from which the part has the value.
[[nodiscard]] std::string in_frame(const FrameJob& frame, std::size_t part,
                                   const std::string& pointer);
[[nodiscard]] Problem in_frame(const FrameJob& frame, std::size_t part, Problem problem);

}  // namespace tubecut::api
