#pragma once

#include <optional>
#include <stop_token>

#include "core/part/part.hpp"

namespace tubecut::part {

/// What one side of a web is: a hole, or the cut of an end.
enum class Beside { hole, start, finish };

/// A place where little of the wall is left: between a hole and another one, or an end.
struct Web {
  double width = 0.0;    // the shortest way over the wall, mm; 0 where nothing is left
  double radius = 0.0;   // of the surface on which it is that short
  std::size_t hole = 0;  // of Part::holes
  Beside beside = Beside::hole;
  std::size_t other = 0;  // that hole
  EdgePoint from, to;     // of the hole's edge; of the other's
};

/// How near a hole comes to the datum line, round the tube.
struct SeamGap {
  double girth = 0.0;  // mm; 0 where the hole lies across it
  std::size_t hole = 0;
};

/// The narrowest places of a part. Empty where there is no hole, or no second one.
struct Webs {
  std::optional<Web> between_holes, to_end;
  std::optional<SeamGap> to_seam;

  [[nodiscard]] const std::optional<Web>& narrowest() const;
};

/// Ways are measured on the developed outside and on the developed bore, between edges that run
/// straight from row to row; of both the shorter counts.
///
/// Accuracy  exact but for rounding, 1e-12 of the lengths involved.
/// Cost      about 5 ns for each two pieces that come near each other. Once stopped the value has
///           no meaning.
[[nodiscard]] Webs webs(const PartSpec& spec, const Part& part, const std::stop_token& stop = {});

}  // namespace tubecut::part
