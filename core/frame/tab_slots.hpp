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
  std::string name = {};  // of the slots: name.0, name.1
  std::vector<StatedTab> tabs;
  cutout::TabClearance clearance;
  double proud = 0.0;                      // mm, of the tabs beyond the bore
  double end_kerf = 0.0, slot_kerf = 0.0;  // mm, of the beams that cut the two
};

/// A slot on a face of the chord's part: `along` the tube before it is turned.
struct FaceSlot {
  int face = 1;
  double z = 0.0, offset = 0.0;  // mm, of its middle; z from the start's work point
  double along = 0.0, round = 0.0, corner = 0.0;
  double turn = 0.0;  // rad, from +z towards growing s
};

struct FittedTab {
  part::EndTab tab;
  FaceSlot slot;
};
struct FittedTabs {
  std::size_t branch = 0, chord = 0;   // members: with tabs, with slots
  joint::End end = joint::End::start;  // of the branch
  std::vector<FittedTab> tabs;         // in the stated order
};

/// Computes both sides of a joint with tabs between two rectangular members. All problems are
/// reported at once.
///
/// Errors  at joints/i: joint_contradicts (between: the second member is the one that is cut on the
///         first), unsupported_combination (between/0, between/1: a member without faces; kind:
///         another body cuts this end too), out_of_range (clearance: the slot's corners meet the
///         tab's, or the beam's fillets hold the shoulder off; tab_slots/k/width: beyond the flat,
///         or the slot is no wider than the beam; tab_slots/k/offset: beyond the chord's flat, or
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
