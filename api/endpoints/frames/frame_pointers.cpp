#include "api/endpoints/frames/frame_pointers.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace tubecut::api {
namespace {

using Steps = std::vector<std::string_view>;

Steps steps_of(std::string_view path) {
  Steps out;
  while (!path.empty()) {
    if (path.front() == '/') path.remove_prefix(1);
    const auto end = std::min(path.find('/'), path.size());
    out.push_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return out;
}

std::optional<std::size_t> index_at(const Steps& steps, std::size_t i) {
  if (i >= steps.size()) return std::nullopt;
  std::size_t out = 0;
  const auto [end, error] =
      std::from_chars(steps[i].data(), steps[i].data() + steps[i].size(), out);
  const bool whole = error == std::errc{} && end == steps[i].data() + steps[i].size();
  return whole ? std::optional(out) : std::nullopt;
}

std::string from(const Steps& steps, std::size_t first) {
  std::string out;
  for (auto i = first; i < steps.size(); ++i) out += "/" + std::string(steps[i]);
  return out;
}

/// Returns the piece that has a member's end, with the request's index.
std::string end_in_request(const FrameJob& frame, std::size_t member, bool finish) {
  if (!frame.merged) return "/" + std::to_string(member) + (finish ? "/end" : "/start");
  const auto& pieces = frame.merged->pieces[member];
  const auto piece = finish ? pieces.back() : pieces.front();
  const bool end = frame.merged->of[piece].turned != finish;
  return "/" + std::to_string(piece) + (end ? "/end" : "/start");
}

std::size_t earliest_piece(const FrameJob& frame, std::size_t member) {
  return frame.merged ? std::ranges::min(frame.merged->pieces[member]) : member;
}

std::string member_at(const FrameJob& frame, std::size_t member) {
  return "/members/" + std::to_string(earliest_piece(frame, member));
}

std::string joint_at(const FrameJob& frame, std::size_t stated) {
  return "/joints/" + std::to_string(frame.merged ? frame.merged->joints[stated] : stated);
}

std::string other_at(const FrameJob& frame, std::size_t other) {
  return "/others/" + std::to_string(frame.others[other]);
}

/// The sources of one part's request in the frame's request.
class Sources {
 public:
  Sources(const FrameJob& frame, std::size_t part)
      : frame_(frame), member_(frame.parts[part].by), piece_(frame.frame.pieces[member_]) {}

  [[nodiscard]] std::string of(const Steps& steps) const {
    if (steps.empty()) return member_at(frame_, member_);
    if (steps[0] == "ends" && steps.size() > 1) return of_end(steps);
    if (steps[0] == "holes") return of_hole(steps);
    if (steps[0] == "marks") {
      const auto i = index_at(steps, 1);
      return member_at(frame_, i && *i < piece_.stands.size() ? piece_.stands[*i].member : member_);
    }
    if (steps[0] == "target") {
      const bool sized = steps.size() > 1 && steps[1] != "length_mm" && steps[1] != "id";
      return member_at(frame_, member_) + (sized ? from(steps, 1) : "");
    }
    if (steps[0] == "cutouts")
      if (const auto slot = frame_.slots.find({member_, index_at(steps, 1).value_or(0)});
          slot != frame_.slots.end() && steps.size() > 1)
        return tab_at(slot->second.first, slot->second.second);
    if (steps[0] == "cutouts" || steps[0] == "texts")
      return member_at(frame_, member_) + from(steps, 0);
    for (const auto& [name, value] : frame_.once)
      if (name == steps[0]) return from(steps, 0);
    return member_at(frame_, member_);
  }

 private:
  [[nodiscard]] std::string tab_at(std::size_t stated, std::size_t tab) const {
    return joint_at(frame_, stated) + "/tab_slots/" + std::to_string(tab);
  }
  [[nodiscard]] const OwnCut* said(std::size_t joint) const {
    const auto& stated = frame_.frame.joints[joint].stated;
    return stated ? &frame_.cuts[*stated] : nullptr;
  }
  [[nodiscard]] std::string joint(std::size_t index, const std::string& rest) const {
    const auto& stated = frame_.frame.joints[index].stated;
    return stated ? joint_at(frame_, *stated) + rest : "/defaults" + rest;
  }
  [[nodiscard]] std::string partner(std::size_t index, const std::string& rest) const {
    const auto& one = frame_.frame.joints[index];
    const bool size = rest == "/outer_diameter_mm";
    if (one.other) return other_at(frame_, one.chord) + (size ? rest : "");
    if (one.plate) return "/plates/" + std::to_string(one.chord);
    const bool faces =
        one.how.kind == frame::How::Kind::mitre || one.how.kind == frame::How::Kind::butt;
    if (faces && one.stated) return joint_at(frame_, *one.stated);
    return member_at(frame_, one.branch == member_ ? one.chord : one.branch) + (size ? rest : "");
  }

  /// Returns the source of an end's cut: the end, else its joints, else the defaults.
  [[nodiscard]] std::string of_cut(const Steps& steps, bool finish) const {
    using Field = std::pair<std::string_view, Json OwnCut::*>;
    static constexpr std::array kFields{
        Field{"groove", &OwnCut::groove}, Field{"contact", &OwnCut::contact},
        Field{"root_face_mm", &OwnCut::root_face}, Field{"smoothing", &OwnCut::smoothing},
        Field{"kerf_mm", &OwnCut::kerf}};
    const auto field = std::ranges::find(kFields, steps[2], &Field::first);
    if (field != kFields.end()) {
      const auto end = finish ? joint::End::finish : joint::End::start;
      for (std::size_t i = 0; i < frame_.ends.size(); ++i)
        if (const auto& own = frame_.ends[i]; own.member == member_ && own.end == end)
          if (!(own.cut.*field->second == Json{}))
            return "/ends/" + std::to_string(i) + from(steps, 2);
      for (const auto& one : finish ? piece_.finish : piece_.start)
        if (const auto* own = said(one.joint); own != nullptr && !(own->*field->second == Json{}))
          return joint(one.joint, from(steps, 2));
      if (steps[2] == "kerf_mm") return "/kerf_mm";
    }
    return "/defaults" + from(steps, 2);
  }
  [[nodiscard]] std::string of_end(const Steps& steps) const {
    const bool finish = steps[1] == "finish";
    const auto& cutters = finish ? piece_.finish : piece_.start;
    const auto index = index_at(steps, 3);
    const auto own = "/members" + end_in_request(frame_, member_, finish) + "_mm";
    if (steps.size() < 3 || steps[2] == "square_at_mm" || cutters.empty()) return own;
    if (steps[2] == "end_tabs" && index && frame_.frame.joints[cutters.front().joint].stated)
      return tab_at(*frame_.frame.joints[cutters.front().joint].stated, *index) + from(steps, 4);
    if (steps[2] != "cutters" && steps[2] != "joints") return of_cut(steps, finish);
    if (!index) return own;
    if (steps[2] == "cutters")
      return *index < cutters.size() ? partner(cutters[*index].joint, from(steps, 4)) : own;
    std::size_t at = 0;
    for (const auto& one : cutters)
      if (one.stated && at++ == *index) return joint(one.joint, from(steps, 4));
    return own;
  }

  [[nodiscard]] std::string of_hole(const Steps& steps) const {
    const auto index = index_at(steps, 1);
    if (!index || *index >= piece_.holes.size()) return member_at(frame_, member_);
    const auto& hole = piece_.holes[*index];
    const auto branch = member_at(frame_, hole.member);
    if (steps.size() < 3) return branch;
    if (steps[2] == "branch") {
      const bool sized =
          steps.size() > 3 && (steps[3] == "outer_diameter_mm" || steps[3] == "wall_mm");
      return branch + (sized ? from(steps, 3) : "");
    }
    if (steps[2] == "joint") return joint(hole.joint, from(steps, 3));
    const auto* own = said(hole.joint);
    const bool stated =
        own != nullptr && !((steps[2] == "tilt" ? own->tilt : own->groove) == Json{});
    return (stated ? joint(hole.joint, "") : "/defaults") + from(steps, 2);
  }

  const FrameJob& frame_;
  std::size_t member_;
  const frame::Piece& piece_;
};

}  // namespace

std::string in_request(const FrameJob& frame, const std::string& path) {
  const auto steps = steps_of(path);
  const auto index = index_at(steps, 1);
  if (!index) return path;
  if (steps[0] == "others" && *index < frame.others.size())
    return other_at(frame, *index).substr(1) + from(steps, 2);
  if (!frame.merged) return path;
  if (steps[0] == "joints" && *index < frame.merged->joints.size())
    return joint_at(frame, *index).substr(1) + from(steps, 2);
  if (steps[0] != "members" || *index >= frame.merged->pieces.size()) return path;
  const bool start = steps.size() > 2 && steps[2] == "start";
  if (start || (steps.size() > 2 && steps[2] == "end"))
    return "members" + end_in_request(frame, *index, !start) + from(steps, 3);
  return member_at(frame, *index).substr(1) + from(steps, 2);
}

Error in_request(const FrameJob& frame, Error error) {
  for (auto& issue : error.issues) issue.member = in_request(frame, issue.member);
  return error;
}

std::string in_frame(const FrameJob& frame, std::size_t part, const std::string& pointer) {
  return Sources(frame, part).of(steps_of(pointer));
}

Problem in_frame(const FrameJob& frame, std::size_t part, Problem problem) {
  for (auto& issue : problem.issues) {
    const bool of_end = issue.pointer.starts_with("/ends/");
    issue.pointer = in_frame(frame, part, issue.pointer);
    if (issue.code == ErrorCode::open_profile && of_end)
      issue.hint +=
          "; if the member is wider than the one that it meets, give it the lower priority "
          "number, so that its end stays square, or cut it by a plane in others";
  }
  auto out = field_problem(std::move(problem.issues));
  out.code = problem.code;
  for (auto& one : problem.suspicions) one.member = in_frame(frame, part, one.member);
  out.suspicions = std::move(problem.suspicions);
  return out;
}

}  // namespace tubecut::api
