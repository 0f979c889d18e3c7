#pragma once

#include <cstdint>
#include <vector>

#include "core/base/variant.hpp"
#include "core/cutout/chain.hpp"

namespace tubecut::cutout {

struct Circle {
  double diameter = 0.0;
};
struct Slot {
  double length = 0.0, width = 0.0;  // over all
};
struct Rectangle {
  double along = 0.0, round = 0.0, radius = 0.0;
};
struct Contour {
  Flat start = Flat::Zero();
  std::vector<DrawnSegment> pieces;
  bool mirrored = false;
  bool of_file = false;  // read from a DXF text: errors state places of the drawing, not pieces
};
/// What the beam takes along a line.
struct Slit {
  enum class Pierce : std::uint8_t {
    middle,  // then to the end nearer to the start, and back through the cut to the other
    end      // the one nearer to the start, then to the other
  };
  double length = 0.0;  // of the torch's way
  double width = 0.0;   // of the beam
  Pierce pierce = Pierce::middle;
};
using Shape = Variant<Circle, Slot, Rectangle, Contour, Slit>;

/// A slit's line in its local plane, from the end nearer to the tube's start to the other one.
struct SlitLine {
  Flat from = Flat::Zero(), to = Flat::Zero();

  [[nodiscard]] bool operator==(const SlitLine&) const = default;
  /// The place of the line that is nearest to another place.
  [[nodiscard]] Flat nearest(const Flat& p) const;
  /// The torch's way from its pierce on, with places at most `apart` from each other.
  [[nodiscard]] std::vector<Flat> way(Slit::Pierce pierce, double apart) const;
};
[[nodiscard]] SlitLine slit_line(const Slit& slit, double turn);

/// The edge of what the beam takes: within half a beam of the line.
[[nodiscard]] inline Chain slit(double length, double width) { return slot(length + width, width); }

}  // namespace tubecut::cutout
