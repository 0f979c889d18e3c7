#pragma once

#include <string>
#include <vector>

#include "api/endpoints/frames/frame_answer.hpp"
#include "api/endpoints/frames/frame_request.hpp"
#include "api/wire/reader.hpp"

/// Joints of kind tab_slot: tabs on a member's end, and slots in another.
namespace tubecut::api {

/// Reads the fields of such a joint.
[[nodiscard]] frame::TabStatement decode_tab_slots(Reader& in, std::size_t joint);
/// Marks these fields as known, of a joint whose kind is not.
void note_tab_slots(Reader& in);

/// Returns the names of a joint's slots among the cut-outs of their member.
[[nodiscard]] std::vector<std::string> slot_names(const frame::TabStatement& stated);

/// Returns the cut of an end with tabs: square, set on, so that its own fields need no other value.
[[nodiscard]] OwnCut cut_with_tabs();

/// Computes the tabs and slots of a solved frame, and adds them to its ends and cut-outs, with
/// their warnings.
/// Errors  those of frame::fit_tabs; duplicate_id (joints/i/id: a cut-out of the member has the name
///         of a slot). All of them at once.
[[nodiscard]] Result<void> add_tab_slots(FrameJob& frame);

/// Verifies the slots of all such joints against their tabs, by the parts' own requests.
[[nodiscard]] std::vector<Check> verify_tab_slots(const FrameJob& frame);

}  // namespace tubecut::api
