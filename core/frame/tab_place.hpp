#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/cutout/tab_slot.hpp"
#include "core/frame/tab_slots.hpp"

/// Where tabs and the walls that they go into lie.
namespace tubecut::frame {

inline constexpr double kLeastSine = 0.35;  // of the angle between tab and wall: about 20 deg

/// A face of a member's part in the world.
struct WorldFace {
  Eigen::Vector3d point, normal, round, along;  // on its middle line; round: as s grows

  WorldFace(const joint::Member& member, const Piece& piece, int face);
};

/// A tab in the world: its middle line and its sides.
struct WorldTab {
  Eigen::Vector3d middle;  // of the wall's thickness, anywhere along the line
  cutout::Tab tab;
};
[[nodiscard]] WorldTab tab_in_world(const FrameSpec& spec, const Frame& frame, std::size_t branch,
                                    joint::End end, const StatedTab& stated);

/// A tab at a round chord.
struct RoundEntry {
  cutout::RoundTab tab;
  cutout::RoundWall wall;
  double phi = 0.0;           // rad, of the side that it comes from, in the chord's part
  double sine = 0.0;          // of the angle between both axes
  double askew = 0.0;         // rad, that its sides are turned out of the chord's
  bool across = false;        // its width lies across the chord
  Eigen::Vector2d clearance;  // across the chord and along it
};
/// Returns the entry of a tab into the round tube of a piece, or nothing if their axes are
/// parallel.
[[nodiscard]] std::optional<RoundEntry> entry_of(const Piece& piece, const WorldTab& tab,
                                                 const cutout::TabClearance& clearance);
/// Returns the most that a tab with its clearance may reach from the chord's middle plane, so that
/// it meets the bore at 20 deg or more, mm; 0 if it meets the axis at less.
[[nodiscard]] double most_across(const RoundEntry& entry);

/// Returns the smallest slot with corners that the beam can follow; `along`: with walls that follow
/// the tab.
[[nodiscard]] FaceSlot slot_of(const RoundEntry& entry, bool along, double kerf);

/// Returns by how much a tab lacks its clearances in a slot of a round chord's part.
[[nodiscard]] double tab_lacks(const RoundEntry& entry, const FaceSlot& slot);

}  // namespace tubecut::frame
