#pragma once

#include <Eigen/Core>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/joint/node/node.hpp"

namespace tubecut::joint {

/// Metal that two finished members share. Lengths in mm.
struct Overlap {
  std::size_t a = 0, b = 0;                      // members, a < b
  double depth = 0.0;                            // how far the one's metal lies inside the other
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // there, in the world
};

/// Pairs of members whose axes come nearer than their radii that are looked at, and pairs that may
/// be found to share metal: both grow with the square of the members.
inline constexpr std::size_t kMostNearPairs = 1'000'000, kMostOverlaps = 5'000;

/// What else cuts each end of a node's members (2 i, 2 i + 1), in the end's own frame: surfaces
/// that stand in no list of members. May be empty.
using Beside = std::vector<std::vector<Cutter>>;

/// The members that share metal once cut: modelled twice, crossing, beside each other at a node
/// with neither cutting the other, or along each other. Metal is the wall, between the bore and the
/// outer surface and between both ends: flush with their seats as `nodes` tells and with what cuts
/// them `beside`, square at the work point where nothing does. Grooves and holes are not counted
/// out, nor pairs looked at that by what is stated are set in, pass through, or are mitred. `only`:
/// the pairs of this one.
///
/// Errors    wrong_count (members: more pairs than may be looked at, or than may overlap),
///           cancelled.
/// Accuracy  told if a ball of 0.01 mm fits into both walls, decided by bounds (`shared_metal`);
///           depth within 0.01 mm and 1e-3 radii.
/// Cost      5 us for a pair whose axes come nearer than their radii, 0.1 ms where the walls are
///           1 mm apart, 1 ms for one that overlaps.
/// Source    docs/theory/intersections-and-bevels.md, section 1.4.
[[nodiscard]] Result<std::vector<Overlap>> overlaps(const NodeSpec& spec, const Nodes& nodes,
                                                    std::optional<std::size_t> only = {},
                                                    const std::stop_token& stop = {},
                                                    const Beside& beside = {});

/// One warning of each pair, at its earlier member; with `only` at that one.
[[nodiscard]] std::vector<Warning> warnings_of(const NodeSpec& spec,
                                               const std::vector<Overlap>& overlaps,
                                               std::optional<std::size_t> only = {});

/// The warnings of `nodes`; of a mitre's two ends, which say the same of each other, the earlier's.
[[nodiscard]] std::vector<Warning> once_a_pair(const NodeSpec& spec, const Nodes& nodes);

}  // namespace tubecut::joint
