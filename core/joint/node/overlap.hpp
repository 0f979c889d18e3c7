#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/joint/node/node.hpp"

namespace tubecut::joint {

/// An overlap of the metal of two finished members. Lengths in mm.
struct Overlap {
  std::size_t a = 0, b = 0;                      // members, a < b
  double depth = 0.0;                            // maximum depth of one's metal inside the other
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // the point of that depth, in the world
};

/// Limits of the pairs of members whose axes come nearer than their radii, and of the pairs that
/// overlap, because both grow with the square of the members.
inline constexpr std::size_t kMostNearPairs = 1'000'000, kMostOverlaps = 5'000;

/// Further bodies that cut each end of a node's members (2 i, 2 i + 1), in the end's own frame:
/// surfaces outside the list of members. May be empty.
using Beside = std::vector<std::vector<Cutter>>;

/// Finds the finished members that overlap: modelled twice, crossing, adjacent at a node without
/// cutting each other, or along each other. Metal is the wall between bore and outer surface and
/// between both ends: flush with the seats in `nodes` and `beside`, square at the work point if
/// nothing cuts the end. Grooves and holes are not subtracted, and pairs that are stated as set in,
/// through or mitred are skipped. `only`: only the pairs of this member.
///
/// Errors    wrong_count (members: too many pairs to check, or too many overlaps), cancelled.
/// Accuracy  reported if a ball of 0.01 mm fits into both walls, decided by bounds
///           (`shared_metal`); depth within 0.01 mm and 1e-3 radii.
/// Cost      5 us for a pair whose axes come nearer than their radii, 0.1 ms if the walls are 1 mm
///           from each other, 1 ms for one that overlaps.
/// Source    docs/theory/intersections-and-bevels.md, section 1.4.
[[nodiscard]] Result<std::vector<Overlap>> overlaps(const NodeSpec& spec, const Nodes& nodes,
                                                    std::optional<std::size_t> only = {},
                                                    const Beside& beside = {});

/// Returns the error of more than `kMostOverlaps`.
[[nodiscard]] tl::unexpected<Error> too_many_overlaps(std::size_t pairs);

/// Returns one warning for each pair, at its earlier member; with `only`, at that one.
[[nodiscard]] std::vector<Warning> warnings_of(const NodeSpec& spec,
                                               const std::vector<Overlap>& overlaps,
                                               std::optional<std::size_t> only = {});

/// Returns the warnings of `nodes`; of the two equal warnings of a mitre's ends, only the
/// earlier's.
[[nodiscard]] std::vector<Warning> once_a_pair(const NodeSpec& spec, const Nodes& nodes);

}  // namespace tubecut::joint
