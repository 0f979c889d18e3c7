#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/cutout/tab_slot.hpp"
#include "core/frame/frame.hpp"
#include "core/part/section/end_tab.hpp"

/// Tabs on a member's end and the slots of the member that they go into, from one statement.
namespace tubecut::frame {

/// One tab, as stated: on a face of the member with tabs.
struct StatedTab {
  int face = 1;
  double offset = 0.0, width = 0.0;  // mm; the offset as s grows in the member's part
};

/// The tabs of a stated joint of kind tab_slot.
struct TabStatement {
  std::size_t joint = 0;  // index of the stated joint
  std::string name = {};  // of the slots: name.0, name.1; empty: that of the member with the tabs
  std::vector<StatedTab> tabs;
  cutout::TabClearance clearance;
  double proud = 0.0;                      // mm, of the tabs beyond the bore
  double end_kerf = 0.0, slot_kerf = 0.0;  // mm, of the beams that cut the two
  bool along = false;                      // the slots' walls follow the tabs
  bool tilts = true;                       // the torch that cuts the slots
};

/// A slot on a face of the chord's part, or of a round one: `along` the tube before it is turned.
struct FaceSlot {
  int face = 1;                  // 0: of a round tube
  double phi = 0.0;              // rad, of a round tube
  double z = 0.0, offset = 0.0;  // mm, of its middle; z from the start's work point
  double along = 0.0, round = 0.0, corner = 0.0;
  double turn = 0.0;   // rad, from +z towards growing s
  bool prism = false;  // of a round tube: its walls are straight along the tab, else square
};

struct FittedTab {
  part::EndTab tab;
  FaceSlot slot;
};
struct FittedTabs {
  std::size_t branch = 0, chord = 0;   // members: with tabs, with slots
  joint::End end = joint::End::start;  // of the branch
  std::vector<FittedTab> tabs;         // in the stated order
  double stands_off = 0.0;             // mm, of the shoulder from the wall, on the beam's fillets
};

/// Returns the member of a joint of kind tab_slot that has the tabs: the first one, unless only the
/// second one ends on the other.
[[nodiscard]] std::size_t tabbed_member(const FrameSpec& spec, const StatedJoint& joint);

/// Computes both sides of a joint with tabs of a rectangular member in a rectangular or round one.
/// All problems are reported at once.
///
/// Errors  at joints/i: joint_contradicts (between: the member with the tabs is not cut on the
///         other), unsupported_combination (between/0: a member without faces; kind: another body
///         cuts this end too; slot_wall: walls along a tab that leans, or in a round wall one that
///         is off the middle, or a torch that does not tilt; tab_slots/k/face: it lies askew to a
///         round chord), slot_too_narrow (clearance: the slot's round corners meet the tab's),
///         out_of_range (tab_slots/k/width: beyond the flat, too wide for a round chord, or the
///         slot is no wider than the beam; tab_slots/k/offset: beyond the chord's flat or bore, or
///         too near to another tab; proud: it meets the far wall).
/// Source  docs/theory/cutouts.md, section 10.
[[nodiscard]] Result<FittedTabs> fit_tabs(const FrameSpec& spec, const Frame& frame,
                                          const TabStatement& stated);

/// Returns by how much the requested parts of a joint lack the stated clearances, mm: the tab's
/// corners are placed in the world from the branch's part, the slots from the chord's, and compared
/// at 33 depths; and by how much a tab's tip differs from where it was stated.
[[nodiscard]] double tabs_lack(const FrameSpec& spec, const Frame& frame,
                               const TabStatement& stated, const FittedTabs& asked);

}  // namespace tubecut::frame
