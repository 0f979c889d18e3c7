#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/wire/format.hpp"
#include "core/torch/torch_cut.hpp"

namespace tubecut::api {

/// The cuts of a program, in order.
struct TorchJob {
  double outer_radius = 0.0;                     // around a section that of a circle as long
  std::optional<section::Section> section = {};  // of a target that is not round
  double wall = 0.0;
  std::vector<torch::TorchCut> cuts = {};
  std::vector<std::string> lengths = {}, by_hand = {};  // lines of the header
  // Positions of z = 0 and phi = 0, the direction of z, and the viewing side.
  std::string zero = {}, onward = {}, line = {}, seen_from = {};
  std::vector<std::string> process = {};  // lines of the header about the machine's table
  double shortest_lead = 0.0;             // mm, if the lead comes from the table
};
/// Of the caption its option `passes`.
/// Errors  throws UnfitOption: passes, if a land has no separate pass.
[[nodiscard]] TorchJob torch_job(const bevel::TableSpec& spec, const bevel::Table& table,
                                 const Caption& caption);
/// The end of a target that is not round: one pass, without tabs.
/// Errors  throws UnfitOption: passes, tabs, start_deg, marks, machine (one without an axis
///         across).
[[nodiscard]] TorchJob torch_job(const section::Section& section, const bevel::TableSpec& spec,
                                 const bevel::SectionTable& table, const Caption& caption);
/// A part that is not round, in the order of its sequence, as its ends; marks are lines of the
/// header. Cut-outs are cut square to their flats.
[[nodiscard]] TorchJob torch_job(const part::SectionPartSpec& spec, const part::SectionPart& part,
                                 const Caption& caption);
/// A part in the order of its sequence; marks are lines of the header.
[[nodiscard]] TorchJob torch_job(const part::PartSpec& spec, const part::Part& part,
                                 const Caption& caption);

/// Throws UnfitOption (passes) if a program lights the torch along a bevel whose land of `land` mm
/// it does not cut, and the request does not confirm it.
void refuse_land(const std::string& of, double land, const FormatOptions& options);

/// Query parameters a program along torch lines reads.
[[nodiscard]] const std::vector<std::string_view>& gcode_options();
/// The cuts in the words of a post, LinuxCNC's unless another is named (the letters here are its):
/// A turns the tube by phi, X (or Z) goes along it, B swings the torch; a G1 to each node and to as
/// many places between as keep tip and both edges within 0.02 mm of straight lines in (phi, z), in
/// inverse time (G93) so that the torch keeps its speed on the outer wall through every mix of
/// axes. Speed is one parameter at the top.
///
/// Each cut: retract, turn, approach; pierce height, torch, delay; cutting height; lead-in, cut,
/// overcut, lead-out; torch out, retract. With a pivot length the linear axes are the pivot's, and
/// the one square to the tube moves too; without, the control must know the tip and move its
/// height. The torch is lit only by the option `torch`. If a hole's torch tilts across, C is that
/// tilt and, with a pivot length, Y is the pivot's position across. Around a section A turns the
/// tube so that the wall's normal points up, and Y and Z follow the wall.
///
/// Errors    throws UnfitOption: lead_mm, start_deg, if a cut has no room or point for them; post,
///           pivot_length_mm, axial, if the post lacks an axis; material, if the metal is thicker
///           than the machine's table.
/// Accuracy  X, Y, Z 1e-5 mm, A 1e-7 deg, B, C 1e-6 deg.
[[nodiscard]] std::string print_gcode(TorchJob job, Caption caption);

}  // namespace tubecut::api
