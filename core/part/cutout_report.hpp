#pragma once

#include <optional>

#include "core/part/edge.hpp"

namespace tubecut::part {

/// A place where little of the wall is left beside a cut-out.
struct CutoutWeb {
  enum class Beside { cutout, hole, start, finish };
  double width = 0.0;      // the shortest way over the wall, mm
  double radius = 0.0;     // of the surface on which it is that short
  std::size_t cutout = 0;  // of the layout's instances
  Beside beside = Beside::cutout;
  std::size_t other = 0;  // that cut-out or hole
  EdgePoint from, to;     // of the cut-out's edge; of the other's
};

/// How near a cut-out comes to the datum line, round the tube.
struct CutoutSeam {
  double girth = 0.0;  // mm; 0 where it lies across
  std::size_t cutout = 0;
};

/// Where the cut-outs leave the least of the tube's section.
struct NetSection {
  double z = 0.0, area = 0.0, share = 1.0;  // mm, mm^2, of the whole section
};

/// The narrowest places beside cut-outs.
struct CutoutReport {
  std::optional<CutoutWeb> between;  // two cut-outs, or one and a hole
  std::optional<CutoutWeb> to_end;
  std::optional<CutoutSeam> to_seam;
  NetSection net;
};

}  // namespace tubecut::part
