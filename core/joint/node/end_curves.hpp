#pragma once

#include <optional>
#include <vector>

#include "core/joint/node/node.hpp"
#include "core/joint/section/section_intersection.hpp"

namespace tubecut::joint {

/// The curves of an end: those of a round member, or of a section.
struct EndCurves : Intersection {
  std::optional<SectionIntersection> of_section = {};
};
/// Computes the curves of `spec.target`, or of the section. Its warnings are in the base either
/// way.
[[nodiscard]] Result<EndCurves> curves(const IntersectionSpec& spec,
                                       const std::optional<section::Section>& section);
[[nodiscard]] std::vector<Check> verify(const IntersectionSpec& spec,
                                        const std::optional<section::Section>& section,
                                        const EndCurves& answer);

/// Computes the curves of every end that is cut on all sides; empty for other ends, and for those
/// whose member is consumed.
///
/// Errors  too_many_nodes (of all ends together), cancelled.
[[nodiscard]] Result<std::vector<std::optional<EndCurves>>> profiles(const NodeSpec& spec,
                                                                     const Nodes& nodes,
                                                                     const Sampling& sampling);

}  // namespace tubecut::joint
