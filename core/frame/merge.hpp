#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "core/frame/frame.hpp"

namespace tubecut::frame {

/// The member that contains a piece, and whether the piece runs in reverse.
struct PieceOf {
  std::size_t member = 0;
  bool turned = false;
};

/// A frame whose members in line are merged.
struct Merged {
  FrameSpec spec;           // members in the order of their earliest pieces
  std::vector<PieceOf> of;  // for each member before: its place now
  std::vector<std::vector<std::size_t>>
      pieces;                       // for each member now: its pieces, from its start on
  std::vector<double> off;          // the distance of their ends to the axis, mm
  std::vector<std::size_t> joints;  // for each joint now: its index before
};

/// Statements about a frame that keep pieces separate or joints merged.
struct MergeSpec {
  std::vector<std::pair<std::size_t, joint::End>> kept;  // ends with statements of their own
  // Returns true if two joints are equal, so that one may represent both.
  std::function<bool(std::size_t, std::size_t)> alike = [](std::size_t, std::size_t) {
    return true;
  };
};

/// Merges members that continue each other into one: equal in diameter, wall, priority and `up`; in
/// line within kButtMost; all their ends within kBesideMost of one axis, and of each other; without
/// a body between them that cuts both on all sides (joint::continued). If a joint of the two is
/// stated, they stay separate, unless it is a butt joint without gap, which is dropped with their
/// ends. They also stay separate if their meeting ends have statements. The result has the name and
/// the direction of its earliest piece.
///
/// Errors  those of joint::solve of members; cancelled.
[[nodiscard]] Result<Merged> merge_in_line(const FrameSpec& spec, const MergeSpec& besides);

}  // namespace tubecut::frame
