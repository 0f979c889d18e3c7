#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/part/edge.hpp"

namespace tubecut::part {

/// Single mistakes possible between the numbers and the tube.
enum class Mistake {
  diameter,      // the tube is 3 mm thicker than the program
  wall,          // its wall is 2 mm thicker
  clocking,      // one end is turned by 5 deg
  mirror,        // one end is cut mirrored
  b_sign,        // B has the wrong sign; the root's edge stays
  pivot_length,  // the pivot length is 5 mm too long: the cut moves by 5 mm tan B along the tube
  // Of a tube that is not round:
  height,        // it is 3 mm higher than the program
  width,         // it is 3 mm wider
  swapped,       // it lies on the wrong side: height and width are exchanged
  quarter_turn,  // one end of a square tube is turned by 90 deg
  corner,        // the corner radius is 2 mm larger
};
/// The mistakes that a round part can have.
inline constexpr std::array kRoundMistakes{Mistake::diameter, Mistake::wall,
                                           Mistake::clocking, Mistake::mirror,
                                           Mistake::b_sign,   Mistake::pivot_length};

enum class Tool { wrap, tape, rule, caliper };

/// A dimension that an operator measures on the finished part with a tape, a wrap template or a
/// rule.
struct CheckDimension {
  std::string name;
  double value = 0.0;  // mm
  Tool tool = Tool::tape;
  std::string measured_from;
  std::vector<Mistake> changes_with;  // mistakes that change it by more than 1 mm on this part
};

/// The finished part as an operator sees it: two closed edges at each end.
struct Shape {
  double outer_radius = 0.0, wall = 0.0;
  Edge start_outer, start_inner, finish_outer, finish_inner;
  bool start_root_outer = false, finish_root_outer = false;
};

/// Returns 8 to 12 dimensions that together reveal each mistake that is visible on the part. For
/// each dimension, the mistakes are applied one at a time to this part, and those that change it by
/// more than 1 mm are listed. If cancelled, returns fewer.
/// Source  docs/theory/parts.md, section 4.
[[nodiscard]] std::vector<CheckDimension> check_dimensions(const Shape& shape);

}  // namespace tubecut::part
