#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/endpoints/frames/frame_part.hpp"
#include "api/endpoints/frames/frame_request.hpp"
#include "api/endpoints/parts.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/writer.hpp"
#include "api/worked.hpp"
#include "core/frame/merge.hpp"

namespace tubecut::api {

/// Maps members and joints to their indices in the request, if pieces in line are merged.
struct Merges {
  std::vector<std::string> ids;                  // of the request's members
  std::vector<frame::PieceOf> of;                // of each of them
  std::vector<std::vector<std::size_t>> pieces;  // of each member of the frame, from its start on
  std::vector<double> off;                       // distance of their ends from its axis, mm
  std::vector<std::size_t> joints;               // of each of the frame's: which it is
};

/// Plates that are alike, made once.
struct PlatePart {
  std::vector<std::size_t> plates;  // in the request's order; the first names it
  Json::Object geometry;            // as it is answered
  std::string sha256;               // of that
};

/// A frame with its detected joints, and its parts as requests.
struct FrameJob : FrameRequest, FrameParts {
  frame::Frame frame = {};
  std::vector<std::size_t> part_of = {};  // of each member

  /// Returns the member's own request, without names; nullptr if it is not valid.
  [[nodiscard]] const Parts::Spec* own(std::size_t member) const {
    return forms[form_of[member]].get();
  }
  /// Returns the position of its part's start in the world.
  [[nodiscard]] joint::MemberFrame start_of(std::size_t member) const {
    return laid[member].stand(frame.pieces[member].frame);
  }
  std::optional<Merges> merged = {};
  std::vector<PlatePart> plate_parts = {};
  std::vector<frame::FittedTabs> fitted = {};  // of each of `tabs`
};

/// A part as /v1/parts answers, or the reason for its absence.
struct MadePart {
  std::unique_ptr<const Worked<Parts>> made;
  std::optional<Problem> problem;

  [[nodiscard]] bool is_open() const { return !made && !problem; }  // still to be made
};
using MadeParts = std::vector<MadePart>;  // in the frame's order; empty before any is made, or all

// Members of the answer, each written from its name on. If no part is made yet, values that need
// one are omitted.

void write_members(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_joints(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_cut_list(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_totals(const FrameJob& frame, const MadeParts& made, Writer& w);
void write_not_cut(const FrameJob& frame, Writer& w);
/// Writes members that consist of several pieces; nothing if no merge was requested.
void write_merged(const FrameJob& frame, Writer& w);
/// Writes each part's answer, equal to that of its own request to /v1/parts, byte by byte.
void write_parts(const FrameJob& frame, const MadeParts& made, Writer& w);

[[nodiscard]] const std::string& name_of_part(const FrameJob& frame, std::size_t part);
[[nodiscard]] std::vector<std::string> members_of_part(const FrameJob& frame, std::size_t part);

/// Position of a finished part in the world as one of its members; rows are its x, y and z there.
struct FramePlace {
  Eigen::Vector3d origin;
  Eigen::Matrix3d rows;
};
[[nodiscard]] FramePlace place_of(const FrameJob& frame, const Worked<Parts>& part,
                                  std::size_t member);

[[nodiscard]] const part::Lengths& lengths_of(const Parts::Out& part);

/// Writes the columns of the cut list of one part after its name, given to `row.field(name, value)`
/// and `row.column(name, texts)`.
template <class Row>
void cut_list_row(const FrameJob& frame, std::size_t i, const MadePart& part, Row& row) {
  const auto& m = frame.spec.members[frame.parts[i].members.front()];
  const auto members = members_of_part(frame, i);
  row.field("count", members.size());
  row.column("members", members);
  row.field("made_by", frame.spec.members[frame.parts[i].by].name);
  row.field("differs_at_most_mm", frame.parts[i].differs);
  if (m.section) {
    row.field("height_mm", m.section->height);
    row.field("width_mm", m.section->width);
  } else {
    row.field("outer_diameter_mm", 2.0 * m.outer_radius);
  }
  row.field("wall_mm", frame.walls[frame.parts[i].members.front()]);
  if (!part.is_open()) row.field("verdict", part.made ? part.made->answer.verdict.status : "none");
  if (!part.made) return;
  const auto& lengths = lengths_of(part.made->out);
  row.field("long_mm", lengths.longest);
  row.field("blank_mm", lengths.blank);
  row.field("girth_mm", m.section ? m.section->outer().girth() : kTwoPi * m.outer_radius);
  row.field("weld_mm", lengths.weld);
  row.field("mass_kg", lengths.mass);
  row.field("result_sha256", part.made->answer.result_sha256);
}

}  // namespace tubecut::api
