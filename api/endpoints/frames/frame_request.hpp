#pragma once

#include <map>
#include <utility>
#include <vector>

#include "api/endpoints/tube_laser.hpp"
#include "api/wire/json.hpp"
#include "api/wire/reader.hpp"
#include "core/frame/frame.hpp"
#include "core/frame/tab_slots.hpp"

namespace tubecut::api {

/// Values of the cuts that a stated joint or an end sets in place of `defaults`; null for the
/// others.
struct OwnCut {
  Json groove = {}, contact = {}, root_face = {};
  Json tilt = {};                  // of a joint
  Json smoothing = {}, kerf = {};  // of an end
  friend bool operator==(const OwnCut&, const OwnCut&) = default;
};

/// The cut of one end, which overrides its joints and the defaults.
struct OwnEnd {
  std::size_t member = 0;
  joint::End end = joint::End::start;
  OwnCut cut = {};
};

/// A /v1/frames request.
struct FrameRequest {
  Preset preset = Preset::none;
  frame::FrameSpec spec;
  std::vector<double> walls;           // of each member as it is given, perhaps out of range
  std::vector<Json::Object> sections;  // of each that is not round: the fields of its section
  std::vector<Json> cutouts, texts;    // of each member; null without
  std::vector<std::size_t> others;     // of each of the others: which of the request's it is
  std::size_t others_left_out = 0;     // of too many, those that no joint names
  Json::Object end;                    // default cut of an end, in the form of a part's end
  Json tilt;                           // of a hole by default
  double alike_within = 0.0;  // mm: if finished surfaces differ by at most this, their parts
                              // are one
  std::vector<OwnCut> cuts;   // of each stated joint
  std::vector<OwnEnd> ends;   // each end once
  bool merge = false;         // pieces in line are one member
  std::vector<frame::TabStatement> tabs;  // of joints of kind tab_slot
  Json::Object once;  // values that every part has once: preset, kerf, torch and
                      // others
  // Once the frame is solved: tabs of ends, and by member and index of a cut-out in `cutouts` the
  // stated joint and the tab that it is the slot of.
  std::map<std::pair<std::size_t, joint::End>, Json> end_tabs = {};
  std::map<std::pair<std::size_t, std::size_t>, std::pair<std::size_t, std::size_t>> slots = {};
};

[[nodiscard]] FrameRequest decode_frame_request(Reader& in);

}  // namespace tubecut::api
