#pragma once

#include <optional>

#include "core/part/part.hpp"

namespace tubecut::part {

/// The other side of a web: a hole, or the cut of an end.
enum class Beside { hole, start, finish };

/// A narrow part of the wall, between a hole and another hole or an end.
struct Web {
  double width = 0.0;    // the shortest path over the wall, mm; 0 if nothing is left
  double radius = 0.0;   // of the surface with the shortest path
  std::size_t hole = 0;  // index in Part::holes
  Beside beside = Beside::hole;
  std::size_t other = 0;  // index of that hole
  EdgePoint from, to;     // on the hole's edge; on the other's
};

/// The distance of a hole to the datum line, around the tube.
struct SeamGap {
  double girth = 0.0;  // mm; 0 if the hole crosses it
  std::size_t hole = 0;
};

/// The narrowest webs of a part. Empty if there is no hole, or no second one.
struct Webs {
  std::optional<Web> between_holes, to_end;
  std::optional<SeamGap> to_seam;

  [[nodiscard]] const std::optional<Web>& narrowest() const;
};

/// Finds the narrowest webs. Distances are measured on the developed outside and on the developed
/// bore, between edges that are straight from row to row; the shorter one counts.
///
/// Accuracy  exact except for rounding, 1e-12 of the lengths involved.
/// Cost      about 5 ns for each two segments that come near each other. If cancelled, the value
///           has no meaning.
[[nodiscard]] Webs webs(const PartSpec& spec, const Part& part);

}  // namespace tubecut::part
