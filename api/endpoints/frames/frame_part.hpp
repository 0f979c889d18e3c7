#pragma once

#include <memory>
#include <string>
#include <vector>

#include "api/endpoints/frames/frame_request.hpp"
#include "api/endpoints/parts.hpp"
#include "api/wire/json.hpp"
#include "core/base/error.hpp"
#include "core/frame/alike.hpp"

namespace tubecut::api {

/// One part to be made: the request of /v1/parts, and the members that are alike.
struct FramePart {
  std::vector<std::size_t> members;  // the first names it
  std::size_t by = 0;                // the member whose own part is made for all of them
  double differs = 0.0;              // from it the parts of the others do nowhere by more, mm
  Json request = {};
  std::string sha256 = {};  // of the request without names, except those of the parts set on it
};

/// The parts, and how each member has its own.
struct FrameParts {
  std::vector<FramePart> parts;
  std::vector<frame::Laid> laid;  // of each member onto the one its part is made by
  // Members by their own requests, without names; nullptr if a request is not valid.
  std::vector<std::unique_ptr<const Parts::Spec>> forms;
  std::vector<std::size_t> form_of;  // of each member
};

/// Returns the part of every member, each made once: members share one part if their finished
/// surfaces differ by at most the requested distance.
/// Errors  joint_contradicts (joints/i/...: two joints of one end require different cuts),
///         unsupported_combination (ends/i/...: the end is left square), cancelled.
[[nodiscard]] Result<FrameParts> parts_of(const FrameRequest& request, const frame::Frame& frame);

}  // namespace tubecut::api
