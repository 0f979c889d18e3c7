#pragma once

#include <stop_token>
#include <vector>

#include "core/part/part.hpp"

namespace tubecut::part {

/// Whether two holes share a piece of the wall: on the bore, in its middle or outside.
[[nodiscard]] bool holes_meet(const joint::Target& target, const bevel::Hole& a,
                              const bevel::Hole& b, const std::stop_token& stop = {});

/// Holes near each other or an end's cut, by the boxes around their edges: each may meet another of
/// its crowd, or the end, and nothing else.
struct Crowd {
  std::vector<const bevel::Hole*> holes;
  bool start = false, finish = false;
};
[[nodiscard]] std::vector<Crowd> crowds(const Part& part);

/// In which direction the strips run that an area is taken by; the area is the same.
enum class Strips { along, around };

/// Volume that a crowd takes out of the wall between the two cuts, the holes' own walls straight in
/// space from edge to edge, mm^3. What two holes share counts once, what lies beyond a cut not at
/// all.
/// Accuracy  12 Gauss points across the wall: within 1e-3 of what is shared.
/// Source    docs/theory/parts.md, section 3.
[[nodiscard]] double crowd_volume(const joint::Target& target, const Part& part, const Crowd& crowd,
                                  Strips strips, const std::stop_token& stop = {});

/// Volume that all holes take out of the wall between the two cuts, mm^3.
/// Accuracy  1e-12 for edges straight between their nodes where a hole is in no crowd.
[[nodiscard]] double holes_volume(const joint::Target& target, const Part& part,
                                  const std::stop_token& stop = {});

}  // namespace tubecut::part
