#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "core/frame/frame.hpp"
#include "core/joint/node/overlap.hpp"

/// For `solve` only.
namespace tubecut::frame::detail {

/// One of the others that cuts an end, by its joint.
struct OtherAt {
  std::size_t other = 0, joint = 0;
};

/// The joints and the members at each, before the change to local frames.
struct Joined {
  joint::NodeSpec node;
  joint::Nodes nodes;
  std::vector<FrameJoint> joints;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t>
      of_members;                            // the earlier member first
  std::vector<std::vector<OtherAt>> others;  // of each end

  [[nodiscard]] std::size_t joint_of(std::size_t a, std::size_t b) const {
    return of_members.at(std::minmax(a, b));
  }
};

/// Returns the surfaces of the others that cut each end, in that end's frame.
[[nodiscard]] joint::Beside seats_of_others(const FrameSpec& spec, const Joined& joined);

/// Returns the end that a stated joint with one of the others belongs to.
/// Errors  ambiguous_connection (joints/i: both are equally near).
[[nodiscard]] Result<joint::End> end_at(const FrameSpec& spec, std::size_t index);

/// Errors  as `solve`.
[[nodiscard]] Result<std::vector<Piece>> pieces(const FrameSpec& spec, const Joined& joined);

}  // namespace tubecut::frame::detail
