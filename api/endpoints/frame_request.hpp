#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "api/endpoints/tube_laser.hpp"
#include "api/json.hpp"
#include "api/reader.hpp"
#include "core/frame/frame.hpp"

namespace tubecut::api {

/// What a stated joint or an end says of its cuts beside `defaults`; null where it says nothing.
struct OwnCut {
  Json groove = {}, contact = {}, root_face = {};
  Json tilt = {};                  // of a joint
  Json smoothing = {}, kerf = {};  // of an end
};

/// How one end is cut, whatever its joints and the defaults say.
struct OwnEnd {
  std::size_t member = 0;
  joint::End end = joint::End::start;
  OwnCut cut = {};
};

/// A /v1/frames request.
struct FrameRequest {
  Preset preset = Preset::none;
  frame::FrameSpec spec;
  Json::Object end;          // how an end is cut by default, as a part's end says it
  Json tilt;                 // of a hole by default
  std::vector<OwnCut> cuts;  // of each stated joint
  std::vector<OwnEnd> ends;  // each end once
  Json::Object once;         // what every part has once: preset, kerf, torch and the like
};

[[nodiscard]] FrameRequest decode_frame_request(Reader& in);

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
