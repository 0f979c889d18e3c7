#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "api/endpoints/frame_request.hpp"
#include "api/json.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {

/// One part to be made: the request of /v1/parts, and the members that are alike.
struct FramePart {
  std::vector<std::size_t> members;  // the first names it
  Json request;
  std::string sha256;  // of the request without names, but for those of the parts that stand on it
};

/// The part of every member, each made once: members that differ by nothing a part shows are one.
/// Errors  joint_contradicts (joints/i/...: two joints of one end ask for other cuts),
///         unsupported_combination (ends/i/...: the end is left square), cancelled.
[[nodiscard]] Result<std::vector<FramePart>> parts_of(const FrameRequest& request,
                                                      const frame::Frame& frame,
                                                      const std::stop_token& stop);

}  // namespace tubecut::api
