#pragma once

#include <cstdint>

namespace tubecut::torch {

/// Bridges of metal that a cut leaves, so that the loose piece is held until it is broken off.
struct Tabs {
  /// The cuts that have tabs: the one that releases the part, both ends, the holes, or all.
  enum class Of : std::uint8_t { last, ends, holes, all };
  int count = 2;       // of each such cut
  double width = 2.0;  // mm of metal at least, on either wall, from kerf to kerf
  Of of = Of::last;
};

inline constexpr int kMostTabs = 12;

}  // namespace tubecut::torch
