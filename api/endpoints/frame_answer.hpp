#pragma once

#include <optional>
#include <vector>

#include "api/endpoints/frame_request.hpp"
#include "api/endpoints/parts.hpp"
#include "api/problem.hpp"
#include "api/worked.hpp"
#include "api/writer.hpp"

namespace tubecut::api {

/// A frame whose joints are found, and its parts as requests, read again as /v1/parts does.
struct FrameJob : FrameRequest {
  frame::Frame frame;
  std::vector<FramePart> parts;
  std::vector<std::optional<Parts::Spec>> asked;  // of each part; none: it is refused when made
  std::vector<std::size_t> part_of;               // of each member
};

/// A part as /v1/parts answers, or why there is none.
struct MadePart {
  std::optional<Worked<Parts>> made;
  std::optional<Problem> problem;

  [[nodiscard]] bool is_open() const { return !made && !problem; }  // still to be made
};
using MadeParts = std::vector<MadePart>;  // in the order of the frame's; none yet, or all

// Members of the answer, each written from its name on. Where no part is made yet, what only a
// part tells is left out.

void write_members(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_joints(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_cut_list(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_totals(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_not_cut(const FrameJob& frame, Writer& w);
/// A part's answer is that of its own request to /v1/parts, byte by byte.
void write_parts(const FrameJob& frame, const MadeParts& made, Writer& w);

[[nodiscard]] const std::string& name_of_part(const FrameJob& frame, std::size_t part);

}  // namespace tubecut::api
