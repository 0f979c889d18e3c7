#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "api/json.hpp"
#include "api/reader.hpp"
#include "core/frame/frame.hpp"

namespace tubecut::api {

/// What a stated joint says of its cuts beside `defaults`; null where it says nothing.
struct JointCut {
  Json groove = {}, contact = {}, root_face = {}, tilt = {};
};

/// A /v1/frames request.
struct FrameRequest {
  frame::FrameSpec spec;
  Json::Object end;            // how an end is cut by default, as a part's end says it
  Json tilt;                   // of a hole by default
  std::vector<JointCut> cuts;  // of each stated joint
  Json::Object once;           // what every part has once: kerf, torch, sampling and the like
};

[[nodiscard]] FrameRequest decode_frame_request(Reader& in);

/// One part to be made: the request of /v1/parts, and the members that are alike.
struct FramePart {
  std::vector<std::size_t> members;  // the first names it
  Json request;
  std::string sha256;  // of the request without names, but for those of the parts that stand on it
};

/// The part of every member, each made once: members that differ by nothing a part shows are one.
/// Errors  joint_contradicts (joints/i/...: two joints of one end ask for other cuts), cancelled.
[[nodiscard]] Result<std::vector<FramePart>> parts_of(const FrameRequest& request,
                                                      const frame::Frame& frame,
                                                      const std::stop_token& stop);

}  // namespace tubecut::api
