#pragma once

#include <vector>

#include "core/part/part.hpp"

namespace tubecut::part {

/// Whether two holes share a piece of the wall: on the bore, in its middle or outside.
[[nodiscard]] bool holes_meet(const joint::Target& target, const bevel::Hole& a,
                              const bevel::Hole& b);

/// The holes that may meet another one or the cut at an end, by the boxes around their edges.
[[nodiscard]] std::vector<const bevel::Hole*> crowded_holes(const Part& part);

/// In which direction the strips run that an area is taken by; the area is the same.
enum class Strips { along, around };

/// Volume that some holes take out of the wall between the two cuts, their own walls straight in
/// space from edge to edge, mm^3. What two holes share counts once, what lies beyond an end's cut not at all.
/// Accuracy  12 Gauss points across the wall: within 1e-3 of what is shared.
/// Source    docs/theory/parts.md, section 3.
[[nodiscard]] double crowded_volume(const joint::Target& target, const Part& part,
                                    const std::vector<const bevel::Hole*>& holes, Strips strips);

/// Volume that all holes take out of the wall between the two cuts, mm^3.
/// Accuracy  1e-12 for edges straight between their nodes where a hole meets nothing, else that of
///           crowded_volume.
[[nodiscard]] double holes_volume(const joint::Target& target, const Part& part);

}  // namespace tubecut::part
