#pragma once

#include <Eigen/Core>

/// Tabs on the end of one tube and the slots of another that they go into. A slot is a rectangle on
/// the wall's outside, cut square through the wall, or of a round wall straight along the tab.
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

/// The wall of a round tube: its radii, mm.
struct RoundWall {
  double outer = 0.0, inner = 0.0;
};
/// A tab that goes into a round tube. x points from the tube's middle plane out to the side that
/// the tab comes from, z along the tube, y across it as the angle around the tube grows; the tab's
/// axis has no part along y. Lengths in mm.
struct RoundTab {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();      // y and z of its middle line at x = 0
  Eigen::Vector2d width = Eigen::Vector2d::UnitY();      // its sides, moved along its axis into the
  Eigen::Vector2d thickness = Eigen::Vector2d::UnitX();  // plane of y and z
  double lean = 0.0;  // how much z grows for each mm that the tab comes out

  /// Half of the room that it takes up at one depth.
  [[nodiscard]] Eigen::Vector2d half() const {
    return 0.5 * (width.cwiseAbs() + thickness.cwiseAbs());
  }
  /// Its least and its greatest distance from the middle plane.
  [[nodiscard]] double nearest() const;
  [[nodiscard]] double farthest() const;
  /// Returns how far in from the outside the bore is, where the tab comes nearest to the middle
  /// plane.
  [[nodiscard]] double deep(const RoundWall& wall) const;
};

/// A slot of a round wall: its sides lie along the tube and around it.
struct RoundSlot {
  double along = 0.0;            // mm
  double low = 0.0, high = 0.0;  // y of its sides, of a prism along x
  double turn = 0.0;             // rad, from x to its middle, of walls square to the tube
  double round = 0.0;            // mm on the outside, of such walls
  double z = 0.0;                // of its middle
};

/// Computes the smallest slot that keeps the clearances (y and z) along y and along z, as a prism
/// and with walls square to the tube. The tab with its clearance lies within the bore's width.
/// Source  docs/theory/cutouts.md, section 10.
[[nodiscard]] RoundSlot slot_in_round(const RoundTab& tab, const RoundWall& wall,
                                      const Eigen::Vector2d& clearance);

/// How the walls of a slot in a round tube lie.
enum class RoundCut {
  square,  // square to the tube
  prism    // along x; the slot's turn is 0
};
/// Returns by how much the tab's corners, and where it crosses the middle plane its sides, come
/// nearer to the slot's sides than the clearances on any of 33 radii, or to its round corners than
/// their edge, mm.
[[nodiscard]] double tab_lacks(const RoundTab& tab, const RoundWall& wall, const RoundSlot& slot,
                               RoundCut cut, const Eigen::Vector2d& clearance, double corner);

/// Returns the largest radius of a slot's corners that a tab with sharp corners clears, mm.
[[nodiscard]] double largest_slot_corner(const TabClearance& clearance);

/// Returns how far fillets of radius `fillet` between a tab's sides and its shoulder hold the
/// shoulder off the wall, mm.
[[nodiscard]] double shoulder_stands_off(double fillet, double clearance);

}  // namespace tubecut::cutout
