#pragma once

#include <functional>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/frame/frame.hpp"

namespace tubecut::frame {

/// A member that another is a piece of, and whether it runs the other way.
struct PieceOf {
  std::size_t member = 0;
  bool turned = false;
};

/// A frame whose members in line are one.
struct Merged {
  FrameSpec spec;                                // members in the order of their earliest pieces
  std::vector<PieceOf> of;                       // of each member before, where it is now
  std::vector<std::vector<std::size_t>> pieces;  // of each now: what it was, from its start on
  std::vector<double> off;                       // how far their ends lie beside its axis, mm
  std::vector<std::size_t> joints;               // of each joint now: which it was
};

/// What is said besides of a frame, and keeps its pieces apart or its joints together.
struct MergeSpec {
  std::vector<std::pair<std::size_t, joint::End>> kept;  // ends that something is said of
  // Are two joints made alike, so that one may stand for both?
  std::function<bool(std::size_t, std::size_t)> alike = [](std::size_t, std::size_t) {
    return true;
  };
};

/// Makes one member of those that continue each other: alike in diameter, wall, priority and `up`;
/// within kButtMost of in line; all their ends within kBesideMost of one axis, and no further than
/// that from each other; nothing between them that cuts both all round (joint::continued). Two of
/// which a joint is stated stay two, unless it is a butt joint without gap, which falls away with
/// their ends; so do those of whose meeting ends something is said. It is called as its earliest
/// piece, and runs the same way.
///
/// Errors  those of joint::solve of members; cancelled.
[[nodiscard]] Result<Merged> merge_in_line(const FrameSpec& spec, const MergeSpec& besides,
                                           const std::stop_token& stop = {});

}  // namespace tubecut::frame
