#pragma once

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
  Json::Object end;           // how an end is cut by default, as a part's end says it
  Json tilt;                  // of a hole by default
  double alike_within = 0.0;  // mm: parts whose finished surfaces differ by no more are one
  std::vector<OwnCut> cuts;   // of each stated joint
  std::vector<OwnEnd> ends;   // each end once
  Json::Object once;          // what every part has once: preset, kerf, torch and the like
};

[[nodiscard]] FrameRequest decode_frame_request(Reader& in);

}  // namespace tubecut::api
