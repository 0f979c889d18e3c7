#pragma once

#include <Eigen/Core>

/// Tabs on the end of one tube and the slots of another that they go into. A slot is a rectangle on
/// the wall's outside, cut square through the wall.
namespace tubecut::cutout {

/// A part of a tube's wall that goes on along the tube's axis.
struct Tab {
  Eigen::Vector3d axis = -Eigen::Vector3d::UnitZ();  // unit, into the wall that it enters
  Eigen::Vector3d face = Eigen::Vector3d::UnitX();   // unit, outward normal of its face
  double width = 0.0, thickness = 0.0;               // mm
};

/// Between a tab and its slot, on each side, mm.
struct TabClearance {
  double width = 0.0, thickness = 0.0;
};

/// A plane wall: its outward normal, square to which it is `thickness` mm.
struct PlaneWall {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double thickness = 0.0;
};

struct PlaneSlot {
  Eigen::Vector3d along, across;  // unit, in the wall; `along` is square to the tab's thickness
  double length = 0.0, width = 0.0;
  Eigen::Vector3d middle;  // from where the tab's middle line meets the outside
};

/// Computes the smallest slot that keeps the clearances. The tab's axis enters the wall: it is not
/// parallel to it.
/// Source  docs/theory/cutouts.md, section 10.
[[nodiscard]] PlaneSlot slot_in_plane(const Tab& tab, const PlaneWall& wall,
                                      const TabClearance& clearance);

/// Returns by how much the corners of the tab, at 33 depths of the wall, come nearer to the slot's
/// sides than the clearances, or to its round corners than their edge, mm; 0 or less if they keep
/// them.
[[nodiscard]] double tab_lacks(const Tab& tab, const PlaneWall& wall, const PlaneSlot& slot,
                               const TabClearance& clearance, double corner);

/// A slot of a round wall whose tab points at the axis: its sides along the tube and around it.
struct RoundSlot {
  double along = 0.0, round = 0.0;
};
/// The wall's radii, mm.
struct RoundWall {
  double outer = 0.0, inner = 0.0;
};

/// Computes the slot as a prism along the tab's axis, from the tab's sides and the clearances of
/// each.
[[nodiscard]] RoundSlot slot_in_round(const RoundSlot& tab, const RoundSlot& clearance);
/// Returns the same slot laid on the outside with its walls square to it. It keeps the clearance on
/// the bore, where it is narrowest.
[[nodiscard]] RoundSlot developed_slot(const RoundSlot& prism, const RoundWall& wall);
/// Computes the slot, a radial prism, of a tab across the tube whose axis makes the angle `alpha`
/// (rad) with the tube's in their common plane.
[[nodiscard]] RoundSlot slot_in_round(const Tab& tab, double alpha, const RoundWall& wall,
                                      const TabClearance& clearance);

/// Returns the largest radius of a slot's corners that a tab with sharp corners clears, mm.
[[nodiscard]] double largest_slot_corner(const TabClearance& clearance);

/// Returns how far fillets of radius `fillet` between a tab's sides and its shoulder hold the
/// shoulder off the wall, mm.
[[nodiscard]] double shoulder_stands_off(double fillet, double clearance);

}  // namespace tubecut::cutout
